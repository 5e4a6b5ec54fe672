#include "saras/collision/forbidden_regions.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

constexpr std::string_view kBlank = " \t\r";

[[noreturn]] void refuse(std::size_t line, const std::string& what) {
  throw ProtocolError("line " + std::to_string(line) + ": " + what);
}

/// Takes the next word off a line; empty at its end.
std::string_view take_word(std::string_view& line) {
  const std::size_t begin = std::min(line.find_first_not_of(kBlank), line.size());
  const std::size_t end = std::min(line.find_first_of(kBlank, begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

/// For messages: what stands in the file, cut short.
std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::string result = "'" + std::string(text.substr(0, kMost)) + (text.size() > kMost ? "…'" : "'");
  std::replace_if(
      result.begin(), result.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, '?');
  return result;
}

template <typename Number>
bool parse(std::string_view word, Number& number) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && end == word.data() + word.size() && !word.empty();
}

/// Lines that are not blank, counted from 1.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}
  bool next(std::string_view& line) {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      line = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++number_;
      if (line.find_first_not_of(kBlank) != std::string_view::npos) {
        return true;
      }
    }
    return false;
  }
  std::size_t number() const { return number_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

std::uint64_t parse_count(Lines& lines, std::uint64_t max_count) {
  std::string_view line;
  if (!lines.next(line)) {
    refuse(1, "the file is empty: must begin with the number of regions");
  }
  const std::string_view whole = line;
  std::uint64_t count = 0;
  const bool number = parse(take_word(line), count) && take_word(line).empty();
  if (!number || count < 1 || count > max_count) {
    refuse(lines.number(), "number of regions = " + shown(whole) + ": must be a whole number in [1, " +
                               std::to_string(max_count) + "]");
  }
  return count;
}

Vector3 parse_point(std::string_view line, std::size_t line_number) {
  const std::string_view whole = line;
  Vector3 point;
  for (int i = 0; i < 3; ++i) {
    const std::string_view word = take_word(line);
    if (word.empty()) {
      refuse(line_number, shown(whole) + ": must be three numbers 'x y z', has " + std::to_string(i));
    }
    if (!parse(word, point[i])) {
      refuse(line_number, "xyz"[i] + std::string(" = ") + shown(word) + ": must be a number");
    }
    if (!std::isfinite(point[i])) {
      refuse(line_number, "xyz"[i] + std::string(" = ") + shown(word) + ": must be finite");
    }
  }
  if (!take_word(line).empty()) {
    refuse(line_number, shown(whole) + ": must be three numbers 'x y z', has more");
  }
  return point;
}

}  // namespace

void VerticesFileOptions::validate() const {
  validate::in_range("scale", scale, 1e-9, 1e9);
  validate::pose("marker_T_file", marker_T_file);
}

std::vector<Corners> parse_vertices(const std::string& text, const VerticesFileOptions& options) {
  options.validate();
  Lines lines(text);
  const std::uint64_t count = parse_count(lines, options.max_count);
  std::vector<Corners> regions;
  // A corner takes at least six characters: memory follows the file, not the count that it claims.
  regions.reserve(static_cast<std::size_t>(std::min<std::uint64_t>(count, text.size() / 48 + 1)));
  std::string_view line;
  for (std::uint64_t region = 1; region <= count; ++region) {
    Corners corners;
    std::size_t first_line = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (!lines.next(line)) {
        refuse(lines.number() + 1, "the file ends: region " + std::to_string(region) + " of " + std::to_string(count) +
                                       " has " + std::to_string(i) + " corners, must have 8");
      }
      first_line = i == 0 ? lines.number() : first_line;
      corners.at(i) = options.marker_T_file * (options.scale * parse_point(line, lines.number()));
    }
    try {
      Parallelepiped::from_corners(corners);
    } catch (const ConfigError& error) {
      refuse(first_line, "region " + std::to_string(region) + ": " + error.what());
    }
    regions.push_back(corners);
  }
  if (lines.next(line)) {
    refuse(lines.number(), shown(line) + " after the last of " + std::to_string(count) +
                               " regions: must be the end of the file (8 corners each)");
  }
  return regions;
}

std::vector<Corners> read_vertices(const std::string& path, const VerticesFileOptions& options) {
  options.validate();
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw ProtocolError(path + ": " + (error ? error.message() : std::string("must be a regular file")));
  }
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error || bytes > options.max_bytes) {
    throw ProtocolError(path + ": size = " + (error ? error.message() : std::to_string(bytes) + " bytes") +
                        ": must be at most " + std::to_string(options.max_bytes) + " bytes");
  }
  std::ifstream file(path, std::ios::binary);
  std::string text(static_cast<std::size_t>(bytes), '\0');
  if (!file.read(text.data(), static_cast<std::streamsize>(bytes))) {
    throw ProtocolError(path + ": cannot be read");
  }
  try {
    return parse_vertices(text, options);
  } catch (const ProtocolError& refusal) {
    throw ProtocolError(path + ": " + refusal.what());
  }
}

std::string format_vertices(const std::vector<Corners>& regions) {
  std::string text = std::to_string(regions.size()) + "\n";
  for (const Corners& corners : regions) {
    for (const Vector3& corner : corners) {
      for (int i = 0; i < 3; ++i) {
        // Not printf: a decimal comma of somebody's locale would ruin the file.
        std::array<char, 32> digits;
        text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), corner[i]).ptr);
        text += i < 2 ? ' ' : '\n';
      }
    }
  }
  return text;
}

}  // namespace saras
