// The set-point stays where the hard fixtures allow it: the nearest allowed position, exactly, with all of them at
// once.
#pragma once

#include "saras/csa/qp.hpp"
#include "saras/csa/teleop_fixture.hpp"
#include "saras/teleop/velocity_integrator.hpp"

namespace saras::csa {

/// The position nearest to the wanted one that obeys the linear rows of all hard fixtures (one quadratic programme, no
/// clipping one after the other). Where a fixture is curved the rows are taken anew at the answer, and what is left
/// after that is cut off: no set-point is beyond a border by more than kBeyond_m, however long the step was.
///
/// A border that is already passed (switched on there, an arm that was pushed) moves nothing by itself: it only refuses
/// to go further out. The own place is always allowed, so there is always an answer.
class FixtureBound final : public PositionBound {
 public:
  static constexpr double kBeyond_m = 1e-6;  ///< so far beyond a border is at the border

  /// Throws ConfigError as FixtureSet does.
  explicit FixtureBound(const std::vector<TeleopFixture>& fixtures);
  Vector3 bound(const Vector3& from, const Vector3& wanted) noexcept override;
  bool empty() const { return set_.fixtures().empty(); }
  void reset(const FixtureState& state) { set_.reset(state); }
  const FixtureState& state() const { return set_.state(); }

 private:
  FixtureOutput look(const Vector3& position) noexcept;
  bool obeys(const FixtureOutput& there) const noexcept;
  void add_rows(const FixtureOutput& found, const Vector3& step, bool only_passed) noexcept;
  Vector3 nearest(const Vector3& wanted_step) noexcept;

  FixtureSet set_;
  QpSolver solver_;  ///< in millimetres, so that its tolerances are far below ours
  int rows_ = 0;
  std::array<double, kMaxFixtures> floor_m_{};  ///< least distance to each border in this step
};

}  // namespace saras::csa
