// Instruments, bodies and endoscopes of the da Vinci as the dVRK's configuration files have them.
//
// Classic instruments (400xxx) have a shaft of 0.4162 m, S and Si instruments (420xxx) one of 0.4670 m. A Classic body
// takes either; an Si body takes S and Si instruments only: with another length its tip would be 50.8 mm off.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "saras/spatial/types.hpp"

namespace saras::dvrk {

enum class Body : std::uint8_t { kClassic, kSi };
enum class Endoscope : std::uint8_t { kStraight, kUp, kDown };

/// One instrument. Angles are limits of both signs.
struct Tool {
  std::string model;            ///< six digits
  std::string name;             ///< as dVRK writes it
  double length_m = 0.0;        ///< DH d of the roll row [m]
  double wrist_offset_m = 0.0;  ///< wrist pitch axis to wrist yaw axis, DH a [m]
  double roll_limit_rad = 0.0;
  double wrist_pitch_limit_rad = 0.0;
  double wrist_yaw_limit_rad = 0.0;
  double jaw_lower_rad = 0.0;
  double jaw_upper_rad = 0.0;
};

inline constexpr double kClassicLength = 0.4162;  ///< shafts of 400xxx [m]
inline constexpr double kSiLength = 0.4670;       ///< shafts of 420xxx [m]

/// All known instruments, by model.
const std::vector<Tool>& tools();

/// By model ("400006") or dVRK name ("LARGE_NEEDLE_DRIVER:400006", "…:400006[12]"). A name alone says nothing of the
/// shaft. Throws ConfigError naming the text and what is known.
const Tool& find_tool(const std::string& text);

/// "classic" or "si". Throws ConfigError.
Body find_body(const std::string& text);

/// "straight", "up" or "down" (30 degrees). Throws ConfigError.
Endoscope find_endoscope(const std::string& text);

}  // namespace saras::dvrk
