// Reader and writer of vertices.txt, the source's file of forbidden regions: a count, then for each region eight
// lines "x y z", corners in the order of shapes.hpp. Blank lines are skipped; anything else is refused.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "saras/collision/shapes.hpp"

namespace saras {

struct VerticesFileOptions {
  double scale = 1.0;                   ///< metres per unit of the file; 0.001 for a file in mm
  Pose marker_T_file;                   ///< applied after the scale: the source permutes axes and adds 0.02 m
  std::uint64_t max_bytes = 64u << 20;  ///< asked of the file system before a byte is read
  std::uint64_t max_count = 100000;     ///< regions
  void validate() const;                ///< throws ConfigError
};

/// Corners in the marker's frame [m]. Throws ProtocolError naming line, value and bound: count, number of corners,
/// numbers, text after the last region, and each region that Parallelepiped refuses.
std::vector<Corners> parse_vertices(const std::string& text, const VerticesFileOptions& options = {});
/// The same of a file. Refused without being read: no regular file, larger than max_bytes.
std::vector<Corners> read_vertices(const std::string& path, const VerticesFileOptions& options = {});
/// With all digits: parse_vertices gives the same numbers back.
std::string format_vertices(const std::vector<Corners>& regions);

}  // namespace saras
