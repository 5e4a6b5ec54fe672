// The numbers of our model of the SARAS arm (mesa). config/mesa_geometry.yaml holds the same ones for the
// URDF; tests/python/test_kinematics_geometry.py compares the two.
//
// The manufacturer's dimensions are not public: these are our choice (docs/frames.md). With the trocar
// 0.10 m below the SCARA plane and 0.18 m in front of the shoulder, shaft tilts up to 50 degrees and depths
// of 30 to 170 mm stay inside all limits.
#pragma once

#include <array>

namespace saras::mesa {

inline constexpr int kJoints = 6;
/// Order of q everywhere. The jaw is not part of q: it moves no frame.
inline constexpr std::array<const char*, kJoints> kJointNames = {"scara_1",     "scara_2",   "universal_1",
                                                                 "universal_2", "insertion", "roll"};

inline constexpr double kScaraLink1 = 0.16;     ///< shoulder to elbow [m]
inline constexpr double kScaraLink2 = 0.16;     ///< elbow to universal joint [m]
inline constexpr double kTipOffset = 0.13;      ///< universal joint to tip at insertion = 0 [m]
inline constexpr double kInstrument = 0.36;     ///< adapter flange to tip [m]
inline constexpr double kShaftRadius = 0.0025;  ///< Click Line instruments: 5 mm shafts [m]

inline constexpr std::array<double, kJoints> kLower = {-2.6, -2.85, -1.0, -1.0, 0.0, -4.7};  ///< [rad], insertion [m]
inline constexpr std::array<double, kJoints> kUpper = {2.6, 2.85, 1.0, 1.0, 0.20, 4.7};      ///< [rad], insertion [m]
inline constexpr std::array<double, kJoints> kSpeed = {3.0, 3.0, 3.0, 3.0, 0.30, 6.0};       ///< [rad/s], [m/s]

/// Where the trocar best lies in sbs_world [m]: scene.yaml places the bases so.
inline constexpr std::array<double, 3> kNominalRcm = {0.18, 0.0, -0.10};
/// Below this depth behind the trocar the shaft's direction is ill defined [m].
inline constexpr double kMinimumDepth = 0.010;

}  // namespace saras::mesa
