// Whether a camera still sees: frozen pictures, and eyes that are out of step.
#pragma once

#include <array>
#include <cstdint>

#include "saras/overlay/image_view.hpp"
#include "saras/spatial/law.hpp"

namespace saras {

/// A number that changes when any pixel does (64 bits of every byte; no cryptography).
std::uint64_t fingerprint(const ImageView& image) noexcept;

struct FrozenWatchConfig {
  Seconds frozen_after_s =
      0.13;               ///< the same picture for so long is frozen; a third image at 15 Hz comes after 0.133 s
  void validate() const;  ///< throws ConfigError
};
struct FrozenWatchInput {
  std::uint64_t fingerprint = 0;  ///< of the image that came now
};
struct FrozenWatchOutput {
  bool frozen = false;
  Seconds unchanged_s = 0.0;
  Status status = Status::kOk;
};
struct FrozenWatchState {
  bool has_image = false;
  std::uint64_t fingerprint = 0;
  Seconds unchanged_s = 0.0;
};

/// One step an image; dt: since the image before it. A real camera's noise changes each picture, so one that comes
/// again byte for byte is an old one. dt not finite or <= 0: the time does not count, the picture does.
class FrozenWatch {
 public:
  explicit FrozenWatch(FrozenWatchConfig config) : config_((config.validate(), config)) {}
  FrozenWatchOutput step(const FrozenWatchInput& input, Seconds dt) noexcept;
  void reset(const FrozenWatchState& state = {}) { state_ = state; }
  const FrozenWatchState& state() const { return state_; }
  const FrozenWatchConfig& config() const { return config_; }

 private:
  FrozenWatchConfig config_;
  FrozenWatchState state_;
};
static_assert(has_law_shape<FrozenWatch, FrozenWatchInput, FrozenWatchState>());

enum class EyeSide : std::uint8_t { kLeft = 0, kRight, kNone };

struct StereoPairingConfig {
  Seconds max_skew_s = 0.010;  ///< stamps of a pair differ by no more, >= 0
  Seconds wait_s = 0.060;      ///< so long an image waits for the other eye's, > 0
  void validate() const;       ///< throws ConfigError
};
struct StereoPairingInput {
  EyeSide arrived = EyeSide::kNone;  ///< whose image came now; kNone: only time has passed
  std::int64_t stamp_ns = 0;         ///< of that image
};
struct StereoPairingOutput {
  std::array<bool, 2> waiting_alone{};  ///< the image of that eye that was waiting before stays without a partner
  bool pair = false;                    ///< the image that came, and the waiting one of the other eye
  bool arrived_alone = false;           ///< the image that came is older than the other eye's by too much
  Status status = Status::kOk;
};
struct StereoPairingState {
  std::array<bool, 2> waiting{};
  std::array<std::int64_t, 2> stamp_ns{};
  std::array<Seconds, 2> waited_s{};
};

/// Pairs the images of two eyes by their stamps. Each image leaves exactly once: in a pair, or alone. dt: since the
/// step before; <= 0 or not finite counts as none.
class StereoPairing {
 public:
  explicit StereoPairing(StereoPairingConfig config) : config_((config.validate(), config)) {}
  StereoPairingOutput step(const StereoPairingInput& input, Seconds dt) noexcept;
  void reset(const StereoPairingState& state = {}) { state_ = state; }
  const StereoPairingState& state() const { return state_; }
  const StereoPairingConfig& config() const { return config_; }

 private:
  StereoPairingConfig config_;
  StereoPairingState state_;
};
static_assert(has_law_shape<StereoPairing, StereoPairingInput, StereoPairingState>());

}  // namespace saras
