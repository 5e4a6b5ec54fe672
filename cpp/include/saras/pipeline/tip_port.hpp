// The port at a tool's tip: mean wrench on the tissue, measured displacement, and the work of both.
#pragma once

#include "saras/pipeline/io.hpp"

namespace saras {

struct TipPortState {
  bool has_last = false;
  Pose base_T_tip;  ///< of the last sample that was billed
  Wrench wrench;    ///< and the wrench then
  bool is_live = false;
  Wrench mean_wrench;  ///< over the last interval between two samples
  Twist twist;         ///< measured, over the same
};

/// One tick's account. work_J: mean wrench . displacement since the last sample; 0 between two samples.
struct TipPortOutput {
  bool live = false;  ///< two samples in a row with a known wrench: else nothing can be billed, nothing be commanded
  Wrench mean_wrench;
  Twist twist;
  double work_J = 0.0;
};

/// Bills at each new sample of the arm, and between two keeps mean wrench and twist of the last interval: an arm that
/// tells its pose at 100 Hz moves in between as well.
class TipPort {
 public:
  /// known: pose and wrench are fresh. interval_s: between a new sample and the last one billed.
  TipPortOutput step(bool known, bool is_new, const Pose& base_T_tip, const Wrench& wrench,
                     Seconds interval_s) noexcept;
  void reset(const TipPortState& state = {}) { state_ = state; }
  const TipPortState& state() const { return state_; }

 private:
  TipPortState state_;
};

}  // namespace saras
