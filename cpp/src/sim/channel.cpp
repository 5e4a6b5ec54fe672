#include "saras/sim/channel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "saras/spatial/validate.hpp"

namespace saras {
namespace {
constexpr Seconds kNever = -std::numeric_limits<Seconds>::infinity();
}

void ChannelConfig::validate() const {
  validate::not_negative("delay_s", delay_s);
  validate::not_negative("jitter_s", jitter_s);
  validate::in_range("loss", loss, 0.0, 1.0);
  validate::in_range("duplicate", duplicate, 0.0, 1.0);
  validate::in_range("reorder", reorder, 0.0, 1.0);
  validate::not_negative("reorder_s", reorder_s);
  validate::not_negative("burst_rate_hz", burst_rate_hz);
  validate::not_negative("burst_s", burst_s);
  validate::in_range("capacity", capacity, 1.0, 1e7);
}

Channel::Channel(ChannelConfig config)
    : config_(config),
      random_(config.seed),
      last_send_(kNever),
      last_arrival_(kNever),
      burst_until_(kNever),
      blackout_until_(kNever),
      hold_until_(kNever) {
  config_.validate();
  flight_.reserve(config_.capacity);
}

bool Channel::comes_later(const Datagram& a, const Datagram& b) noexcept {
  return a.arrival != b.arrival ? a.arrival > b.arrival : a.order > b.order;
}

void Channel::schedule(std::uint64_t id, Seconds arrival) noexcept {
  if (flight_.size() >= config_.capacity) {
    ++counters_.overflowed;
    return;
  }
  flight_.push_back({arrival, order_++, id});
  std::push_heap(flight_.begin(), flight_.end(), comes_later);
}

void Channel::send(std::uint64_t id, Seconds now) noexcept {
  ++counters_.sent;
  // Every datagram takes the same number of draws, so that one impairment can be changed and the others stay.
  const Seconds jitter = config_.jitter_s * random_.uniform();
  const bool is_lost = random_.chance(config_.loss);
  const bool is_duplicated = random_.chance(config_.duplicate);
  const bool is_reordered = random_.chance(config_.reorder);
  const Seconds since_last = std::isfinite(last_send_) ? std::max(0.0, now - last_send_) : 0.0;
  const bool burst_begins = random_.chance(1.0 - std::exp(-config_.burst_rate_hz * since_last));
  last_send_ = now;
  if (burst_begins && now >= burst_until_) {
    burst_until_ = now + config_.burst_s;
  }
  if (is_lost || now < burst_until_ || now < blackout_until_) {
    ++counters_.lost;
    return;
  }
  Seconds arrival = now + config_.delay_s + jitter;
  if (is_reordered) {
    ++counters_.reordered;
    arrival += config_.reorder_s;
  } else {
    arrival = std::max(arrival, last_arrival_);
    last_arrival_ = arrival;
  }
  schedule(id, arrival);
  if (is_duplicated) {
    ++counters_.duplicated;
    schedule(id, arrival + config_.reorder_s);
  }
}

bool Channel::receive(Seconds now, std::uint64_t& id) noexcept {
  if (flight_.empty() || now < hold_until_ || flight_.front().arrival > now) {
    return false;
  }
  std::pop_heap(flight_.begin(), flight_.end(), comes_later);
  id = flight_.back().id;
  flight_.pop_back();
  ++counters_.delivered;
  return true;
}

Seconds Channel::next_arrival() const noexcept {
  return flight_.empty() ? std::numeric_limits<Seconds>::infinity() : std::max(flight_.front().arrival, hold_until_);
}

}  // namespace saras
