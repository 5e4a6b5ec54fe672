#include "saras/runtime/teleop_host.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cmath>

#include "saras/runtime/clock.hpp"
#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

constexpr double kSecond = 1e9;

Seconds age_s(std::int64_t now_ns, std::int64_t received_ns) noexcept {
  return received_ns == 0 ? kNever : static_cast<double>(now_ns - received_ns) / kSecond;
}

void count(std::atomic<std::uint64_t>& counter) noexcept {
  counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

std::unique_ptr<FlightRecorder> recorder(const HostConfig& config) {
  if (config.record_s == 0.0) {
    return nullptr;
  }
  // A second a chunk, and two more: one is being filled, one may be held by the writer.
  const auto per_chunk = static_cast<std::size_t>(std::lround(1.0 / config.loop.period_s));
  return std::make_unique<FlightRecorder>(static_cast<std::size_t>(std::ceil(config.record_s)) + 2, per_chunk);
}

}  // namespace

void HostConfig::validate() const {
  loop.validate();
  console.validate();
  pipeline.validate();
  validate::in_range("silent_period_s", silent_period_s, 0.001, 0.1);
  validate::in_range("record_s", record_s, 0.0, 3600.0);
}

TeleopHost::TeleopHost(HostConfig config)
    : config_((config.validate(), std::move(config))),
      pipeline_(config_.pipeline),
      console_(config_.console),
      recorder_(recorder(config_)),
      told_event_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  loop_ = std::make_unique<PeriodicLoop>(
      config_.loop, [this](const Wake& wake) { step(wake); }, console_.descriptor());
}

TeleopHost::~TeleopHost() {
  stop();
  close(told_event_);
}

void TeleopHost::start() { loop_->start(); }

void TeleopHost::stop() noexcept {
  loop_->stop();
  if (recorder_) {
    recorder_->close();
  }
}

// ---- inputs

void TeleopHost::set_arm_pose(int side, const Pose& base_T_tip, std::int64_t stamp_ns) {
  sides_.at(static_cast<std::size_t>(side)).arm.change([&](ArmSample& arm) {
    arm.base_T_tip = base_T_tip;
    arm.stamp_ns = stamp_ns;
    arm.received_ns = monotonic_ns();
    arm.has_pose = true;
    ++arm.poses;
  });
}

void TeleopHost::set_arm_wrench(int side, const Wrench& exerted) {
  sides_.at(static_cast<std::size_t>(side)).arm.change([&](ArmSample& arm) {
    arm.wrench = exerted;
    arm.has_wrench = true;
    arm.wrench_received_ns = monotonic_ns();
  });
}

void TeleopHost::set_arm_rcm(int side, const Vector3& rcm) {
  sides_.at(static_cast<std::size_t>(side)).arm.change([&](ArmSample& arm) {
    arm.rcm = rcm;
    arm.has_rcm = true;
  });
}

void TeleopHost::set_supervisor(int side, ChannelState state, std::uint64_t engagement, bool clutch) {
  sides_.at(static_cast<std::size_t>(side)).word.change([&](WordSample& sample) {
    sample = {{0.0, state, engagement, clutch}, monotonic_ns()};
  });
}

void TeleopHost::set_nearness(int side, const NearnessInput& nearness) {
  sides_.at(static_cast<std::size_t>(side)).nearness.change([&](NearnessSample& sample) {
    sample = {nearness, monotonic_ns()};
  });
}

void TeleopHost::set_scene(const SceneInput& scene) {
  scene_.change([&](SceneSample& sample) { sample = {scene, monotonic_ns()}; });
}

void TeleopHost::set_fixtures(int side, const csa::FixtureWord& word) {
  sides_.at(static_cast<std::size_t>(side)).fixtures.change([&](csa::FixtureWord& newest) { newest = word; });
}

// ---- the loop

void TeleopHost::step(const Wake& wake) noexcept {
  if (recorder_ && recorder_->close_pending()) {
    recorder_->close();  // here and not with the next step, which may be far
  }
  const bool news = console_.receive(wake.now_ns);
  hold_ = hold_ || wake.hold;
  overrun_ = overrun_ || wake.overrun;
  const Seconds since_s = last_step_ns_ == 0 ? kNever : age_s(wake.now_ns, last_step_ns_);
  const Seconds heard_s = console_.has_newest() ? age_s(wake.now_ns, console_.newest().received_ns) : kNever;
  // A step belongs to a datagram; without one, to the time-out, at its own slow period. A HOLD does not wait.
  const bool silent = heard_s > config_.pipeline.handle_timeout_s && since_s >= config_.silent_period_s;
  if (!news && !silent && !hold_) {
    return;
  }
  gather(wake.now_ns, news);
  // By the sender's clock where the last step was a datagram's too, so that the spacing is exact.
  Seconds dt_s = news && !was_silent_ ? console_.newest().interval_s : since_s;
  was_silent_ = !news;
  if (!(dt_s > 0.0 && std::isfinite(dt_s))) {
    dt_s = config_.loop.period_s;
  }
  FlightTick* record = recorder_ ? recorder_->begin(pipeline_) : nullptr;
  FlightTick& tick = record != nullptr ? *record : tick_;
  tick.index = steps_.load(std::memory_order_relaxed);
  tick.now_ns = wake.now_ns;
  tick.stamp_ns = news ? console_.newest().stamp_ns : wall_ns();
  tick.dt_s = dt_s;
  tick.input = input_;
  tick.output = pipeline_.step(input_, dt_s);
  answer(tick.output, wake.now_ns);
  const std::int64_t arrival_ns = news ? console_.newest().arrival_ns : 0;
  if (arrival_ns > 0) {
    reply_.record(wall_ns() - arrival_ns);
  }
  if (record != nullptr) {
    recorder_->commit();
  }
  tell(tick);
  if (arrival_ns > 0) {
    handed_.record(wall_ns() - arrival_ns);
  }
  last_step_ns_ = wake.now_ns;
  hold_ = overrun_ = false;
  count(steps_);
  if (!news) {
    count(silent_steps_);
  }
}

void TeleopHost::gather(std::int64_t now_ns, bool news) noexcept {
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    gather_side(i, now_ns, news);
  }
  if (scene_.box.update()) {
    input_.scene = scene_.box.value().scene;
  }
  input_.scene.age_s = age_s(now_ns, scene_.box.value().received_ns);
  input_.overrun = overrun_;
  input_.hold = hold_;
}

void TeleopHost::gather_side(std::size_t i, std::int64_t now_ns, bool news) noexcept {
  Side& side = sides_[i];
  SideInput& input = input_.sides[i];
  const ReceivedUp& up = console_.newest();
  input.handle.is_new = news && (i == 0 ? up.left_new : up.right_new);
  if (input.handle.is_new) {
    const TouchballUpSide& handle = i == 0 ? up.packet.left : up.packet.right;
    side.handle_ns = up.received_ns;
    input.handle.simball_T_handle = handle.simball_T_handle;
    input.handle.clutch = handle.clutch;
    input.handle.ledger = handle.ledger;
  }
  input.handle.age_s = age_s(now_ns, side.handle_ns);

  side.arm.box.update();
  const ArmSample& arm = side.arm.box.value();
  input.arm.is_new = arm.has_pose && arm.poses != side.seen_poses;
  if (input.arm.is_new) {
    const std::int64_t passed_ns = side.seen_poses == 0 ? 0 : arm.stamp_ns - side.seen_stamp_ns;
    input.arm.interval_s = passed_ns > 0 ? static_cast<double>(passed_ns) / kSecond : 0.0;
    input.arm.base_T_tip = arm.base_T_tip;
    side.seen_poses = arm.poses;
    side.seen_stamp_ns = arm.stamp_ns;
  }
  input.arm.age_s = age_s(now_ns, arm.received_ns);
  input.arm.has_rcm = arm.has_rcm;
  input.arm.rcm = arm.rcm;
  input.arm.exerted_wrench = arm.wrench;
  input.arm.wrench_age_s = arm.has_wrench ? age_s(now_ns, arm.wrench_received_ns) : kNever;

  side.word.box.update();
  input.channel = side.word.box.value().word;
  input.channel.age_s = age_s(now_ns, side.word.box.value().received_ns);
  side.nearness.box.update();
  input.nearness = side.nearness.box.value().nearness;
  input.nearness.age_s = age_s(now_ns, side.nearness.box.value().received_ns);
  side.fixtures.box.update();
  input.fixtures = side.fixtures.box.value();
}

void TeleopHost::answer(const PipelineOutput& output, std::int64_t now_ns) noexcept {
  TouchballDown packet;
  for (std::size_t i = 0; i < output.sides.size(); ++i) {
    TouchballDownSide& down = i == 0 ? packet.left : packet.right;
    down.touch_wrench = output.sides[i].touch_wrench;
    down.state = output.sides[i].state;
    down.engagement = output.sides[i].engagement;
    down.ledger = output.sides[i].to_guard;
  }
  console_.send(packet, now_ns);
}

void TeleopHost::tell(const FlightTick& tick) noexcept {
  HostSnapshot& told = told_.draft();
  told.tick = tick;
  told.has_up = console_.has_newest();
  told.up = console_.newest().packet;
  told.tools = pipeline_.tools();
  told.distances = pipeline_.distances();
  told.capsules = pipeline_.capsules();
  told.held = false;
  for (std::size_t i = 0; i < tick.output.sides.size(); ++i) {
    told.held = told.held || (tick.input.sides[i].channel.state == ChannelState::kEngaged &&
                              tick.input.sides[i].channel.age_s <= config_.pipeline.channel_timeout_s &&
                              tick.output.sides[i].state == ChannelState::kHold);
  }
  told_.publish();
  const std::uint64_t one = 1;
  (void)!write(told_event_, &one, sizeof(one));
}

// ---- outputs

bool TeleopHost::wait(Seconds timeout_s) {
  pollfd event{told_event_, POLLIN, 0};
  if (poll(&event, 1, static_cast<int>(std::lround(1e3 * timeout_s))) <= 0) {
    return false;
  }
  std::uint64_t drained = 0;
  (void)!read(told_event_, &drained, sizeof(drained));
  const std::lock_guard<std::mutex> lock(reader_);
  return told_.update();
}

HostSnapshot TeleopHost::snapshot() const {
  const std::lock_guard<std::mutex> lock(reader_);
  return told_.value();
}

HostStatistics TeleopHost::statistics() const noexcept {
  HostStatistics statistics;
  statistics.loop = loop_->statistics();
  statistics.steps = steps_.load(std::memory_order_relaxed);
  statistics.silent_steps = silent_steps_.load(std::memory_order_relaxed);
  statistics.reply = reply_.snapshot();
  statistics.handed = handed_.snapshot();
  statistics.left_out = recorder_ ? recorder_->left_out() : 0;
  return statistics;
}

std::uint64_t TeleopHost::write_record(const std::string& path, const std::string& reason) {
  if (!recorder_) {
    throw Error("no flight recorder: record_s is 0");
  }
  const std::lock_guard<std::mutex> lock(record_mutex_);
  if (running()) {
    recorder_->request_close();
    // The loop wakes within a period, unless it is stopped just now: what it has finished is written then.
    const std::int64_t end_ns = monotonic_ns() + 500'000'000;
    while (recorder_->close_pending() && monotonic_ns() < end_ns) {
      sleep_until_ns(monotonic_ns() + 1'000'000);
    }
  }
  return recorder_->write(path, config_.pipeline, reason);
}

}  // namespace saras
