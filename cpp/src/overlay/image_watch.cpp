#include "saras/overlay/image_watch.hpp"

#include <cmath>
#include <cstring>
#include <limits>

#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

constexpr std::uint64_t kPrime = 0x9E3779B97F4A7C15ULL;  // odd: multiplying loses nothing
constexpr std::size_t kLanes = 4;                        // independent, so that the processor overlaps them

std::uint64_t mix(std::uint64_t hash, std::uint64_t word) noexcept {
  hash = (hash ^ word) * kPrime;
  return hash ^ (hash >> 29U);
}

}  // namespace

std::uint64_t fingerprint(const ImageView& image) noexcept {
  std::array<std::uint64_t, kLanes> lanes = {1, 2, 3, 4};
  const std::size_t row_bytes =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(channels(image.format));
  for (int y = 0; y < image.height; ++y) {
    const std::uint8_t* const row = image.data + static_cast<std::size_t>(y) * image.stride;
    std::size_t at = 0;
    for (; at + kLanes * 8 <= row_bytes; at += kLanes * 8) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        std::uint64_t word = 0;
        std::memcpy(&word, row + at + lane * 8, 8);
        lanes[lane] = mix(lanes[lane], word);
      }
    }
    for (; at < row_bytes; ++at) {
      lanes[0] = mix(lanes[0], row[at]);
    }
  }
  std::uint64_t hash = mix(mix(0, static_cast<std::uint64_t>(image.width)), static_cast<std::uint64_t>(image.height));
  for (const std::uint64_t lane : lanes) {
    hash = mix(hash, lane);
  }
  return hash;
}

void FrozenWatchConfig::validate() const { validate::positive("frozen_after_s", frozen_after_s); }

FrozenWatchOutput FrozenWatch::step(const FrozenWatchInput& input, Seconds dt) noexcept {
  FrozenWatchOutput output;
  const bool in_time = is_valid_time_step(dt, std::numeric_limits<double>::infinity());
  if (state_.has_image && state_.fingerprint == input.fingerprint) {
    state_.unchanged_s += in_time ? dt : 0.0;
  } else {
    state_ = {true, input.fingerprint, 0.0};
  }
  output.unchanged_s = state_.unchanged_s;
  output.frozen = state_.unchanged_s >= config_.frozen_after_s;
  output.status = !in_time ? Status::kInvalidTimeStep : output.frozen ? Status::kStale : Status::kOk;
  return output;
}

void StereoPairingConfig::validate() const {
  validate::not_negative("max_skew_s", max_skew_s);
  validate::positive("wait_s", wait_s);
}

StereoPairingOutput StereoPairing::step(const StereoPairingInput& input, Seconds dt) noexcept {
  StereoPairingOutput output;
  const bool in_time = is_valid_time_step(dt, std::numeric_limits<double>::infinity());
  output.status = in_time ? Status::kOk : Status::kInvalidTimeStep;
  for (std::size_t eye = 0; eye < 2; ++eye) {
    state_.waited_s[eye] += in_time ? dt : 0.0;
    if (state_.waiting[eye] && state_.waited_s[eye] > config_.wait_s) {
      output.waiting_alone[eye] = true;
      state_.waiting[eye] = false;
    }
  }
  if (input.arrived != EyeSide::kNone) {
    const auto mine = static_cast<std::size_t>(input.arrived), other = 1 - mine;
    output.waiting_alone[mine] = output.waiting_alone[mine] || state_.waiting[mine];
    state_.waiting[mine] = false;
    // Of stamps only their difference, which fits into a double: absolute ones in nanoseconds do not.
    const double later_s = 1e-9 * static_cast<double>(input.stamp_ns - state_.stamp_ns[other]);
    if (state_.waiting[other] && std::abs(later_s) <= config_.max_skew_s) {
      output.pair = true;
      state_.waiting[other] = false;
    } else if (state_.waiting[other] && later_s < 0.0) {
      output.arrived_alone = true;
    } else {
      output.waiting_alone[other] = output.waiting_alone[other] || state_.waiting[other];
      state_.waiting[other] = false;
      state_.waiting[mine] = true;
      state_.stamp_ns[mine] = input.stamp_ns;
      state_.waited_s[mine] = 0.0;
    }
  }
  if (output.arrived_alone || output.waiting_alone[0] || output.waiting_alone[1]) {
    output.status = output.status == Status::kOk ? Status::kStale : output.status;
  }
  return output;
}

}  // namespace saras
