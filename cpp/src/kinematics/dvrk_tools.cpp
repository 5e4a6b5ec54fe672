#include "saras/kinematics/dvrk_tools.hpp"

#include <algorithm>

#include "saras/spatial/errors.hpp"

namespace saras::dvrk {
namespace {

constexpr double kRoll = 4.53786;         // 260 degrees
constexpr double kRollNarrow = 4.4506;    // 255 degrees
constexpr double kWrist = 1.39626;        // 80 degrees
constexpr double kWristNarrow = 1.2217;   // 70 degrees
constexpr double kJawClosed = -0.349066;  // -20 degrees: beyond closed, to grip
constexpr double kJawOpen = 1.39626;      // 80 degrees
constexpr double kNeedleJawClosed = -0.698132;

struct Kind {
  const char* name;
  const char* classic;  // model with the short shaft, or nullptr
  const char* si;       // model with the long shaft, or nullptr
  double wrist_offset_m, roll, pitch, yaw, jaw_lower, jaw_upper;
};

constexpr Kind kKinds[] = {
    {"LARGE_NEEDLE_DRIVER", "400006", "420006", 0.0091, kRoll, kWrist, kWrist, kNeedleJawClosed, kJawOpen},
    {"DEBAKEY_FORCEPS", "400036", "420036", 0.0091, kRoll, kWrist, kWrist, kJawClosed, kJawOpen},
    {"CADIERE_FORCEPS", "400049", "420049", 0.0091, kRoll, kWrist, kWrist, kJawClosed, kJawOpen},
    {"PROGRASP_FORCEPS", "400093", "420093", 0.0107, kRoll, kWrist, kWrist, kJawClosed, kJawOpen},
    {"MARYLAND_BIPOLAR_FORCEPS", "400172", "420172", 0.0107, kRollNarrow, kWristNarrow, 1.5708, kJawClosed, kJawOpen},
    {"PERMANENT_CAUTERY_HOOK", "400183", "420183", 0.0093, kRoll, kWrist, kWrist, 0.0, 0.5},
    {"PERMANENT_CAUTERY_SPATULA", "400184", "420184", 0.0093, kRoll, kWrist, 1.4835, 0.0, 0.5},
    {"MEGA_NEEDLE_DRIVER", "400194", "420194", 0.0112, kRollNarrow, kWristNarrow, kWrist, kJawClosed, kJawOpen},
    {"LARGE_CLIP_APPLIER", "400230", "420230", 0.0107, kRollNarrow, kWristNarrow, 1.27409, kJawClosed, 0.785398},
    {"MEGA_SUTURECUT_NEEDLE_DRIVER", "400309", "420309", 0.0100, kRollNarrow, kWristNarrow, kWrist, kJawClosed,
     kJawOpen},
    {"MEDIUM-LARGE_CLIP_APPLIER", nullptr, "420327", 0.0107, kRollNarrow, kWristNarrow, 1.27409, kJawClosed, 0.785398},
};

std::vector<Tool> make_tools() {
  std::vector<Tool> list;
  const auto add = [&list](const Kind& kind, const char* model, double length_m) {
    if (model != nullptr) {
      list.push_back({model, kind.name, length_m, kind.wrist_offset_m, kind.roll, kind.pitch, kind.yaw, kind.jaw_lower,
                      kind.jaw_upper});
    }
  };
  for (const Kind& kind : kKinds) {
    add(kind, kind.classic, kClassicLength);
    add(kind, kind.si, kSiLength);
  }
  std::sort(list.begin(), list.end(), [](const Tool& a, const Tool& b) { return a.model < b.model; });
  return list;
}

[[noreturn]] void refuse(const std::string& field, const std::string& text, const std::string& known) {
  throw ConfigError(field + " = '" + text + "': must be one of " + known);
}

}  // namespace

const std::vector<Tool>& tools() {
  static const std::vector<Tool> list = make_tools();  // constant: the same for everyone
  return list;
}

const Tool& find_tool(const std::string& text) {
  std::string known;
  for (const Tool& tool : tools()) {
    const std::string full = tool.name + ":" + tool.model;
    const bool versioned = text.compare(0, full.size() + 1, full + "[") == 0 && text.back() == ']';
    if (text == tool.model || text == full || versioned) {
      return tool;
    }
    known += (known.empty() ? "" : ", ") + full;
  }
  refuse("tool", text, known);
}

Body find_body(const std::string& text) {
  if (text == "classic") {
    return Body::kClassic;
  }
  if (text == "si") {
    return Body::kSi;
  }
  refuse("body", text, "classic, si");
}

Endoscope find_endoscope(const std::string& text) {
  if (text == "straight") {
    return Endoscope::kStraight;
  }
  if (text == "up") {
    return Endoscope::kUp;
  }
  if (text == "down") {
    return Endoscope::kDown;
  }
  refuse("endoscope", text, "straight, up, down");
}

}  // namespace saras::dvrk
