// The scenario of benchmarks/scenario.py, same numbers; see there.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "saras/spatial/rotation.hpp"

namespace saras::benchmarks {

inline constexpr double kDt = 0.01;
inline constexpr int kTicks = 1000;
inline constexpr double kOmega = 2.0 * M_PI * 0.3;
inline constexpr double kScale = 0.5;
inline constexpr double kLag = 0.033;
inline const Vector3 kRcm(0.18, 0.0, -0.10);
inline const Pose kBaseTConsole{rotation_exp(Vector3(0, 0, M_PI_2)), Vector3(0.1, 0.2, 0.3)};
inline const Pose kTouchTConsole{rotation_exp(Vector3(0, 0.3, 0)), Vector3::Zero()};

struct Tick {
  std::array<Pose, 2> handles;
  std::array<Pose, 2> tips;
  std::array<Wrench, 2> tissue;
};

inline Pose handle(double t, double side) {
  const double a = kOmega * t;
  const Vector3 turn(0.3 * std::sin(a), 0.2 * std::cos(a), 0.4 * side * std::sin(a));
  return {rotation_exp(turn), {0.03 * std::sin(a), 0.03 * side * std::cos(a), 0.01 * std::sin(2 * a)}};
}

inline Pose tip(double t, double side) {
  const Vector3 moved = handle(t - kLag, side).translation - handle(0.0, side).translation;
  const Vector3 arm = Vector3(0, 0, -0.11) + kScale * (kBaseTConsole.rotation * moved);
  const Quaternion turn = Quaternion::FromTwoVectors(-Vector3::UnitZ(), arm);
  return {turn * Quaternion(0, 1, 0, 0), kRcm + arm};
}

inline std::vector<Tick> ticks() {
  std::vector<Tick> rows(kTicks);
  for (int i = 0; i < kTicks; ++i) {
    const double t = i * kDt;
    const double force = 0.75 * (1.0 - std::cos(2 * kOmega * t));
    Tick& row = rows[static_cast<std::size_t>(i)];
    row.handles = {handle(t, 1), handle(t, -1)};
    row.tips = {tip(t, 1), tip(t, -1)};
    row.tissue.fill({Vector3(0.2 * force, 0.0, -force), Vector3::Zero()});
  }
  return rows;
}

}  // namespace saras::benchmarks
