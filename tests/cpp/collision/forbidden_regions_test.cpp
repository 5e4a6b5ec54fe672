#include "saras/collision/forbidden_regions.hpp"

#include <gtest/gtest.h>

#include "saras/spatial/errors.hpp"
#include "support/random_values.hpp"

namespace saras {
namespace {

const char* const kCube = "1\n0 0 0\n1 0 0\n1 0 1\n0 0 1\n0 1 0\n1 1 0\n1 1 1\n0 1 1\n";

std::string refusal(const std::string& text, const VerticesFileOptions& options = {}) {
  try {
    parse_vertices(text, options);
  } catch (const ProtocolError& error) {
    return error.what();
  }
  return "";
}

void expect_refusal(const std::string& text, const std::string& words) {
  EXPECT_NE(refusal(text).find(words), std::string::npos) << "'" << refusal(text) << "' has no '" << words << "'";
}

std::string with(std::size_t line, const std::string& replacement) {
  std::string result;
  std::size_t number = 0;
  std::size_t begin = 0;
  const std::string cube = kCube;
  while (begin < cube.size()) {
    const std::size_t end = cube.find('\n', begin);
    result += ++number == line ? replacement : cube.substr(begin, end - begin + 1);
    begin = end + 1;
  }
  return result;
}

TEST(Vertices, ReadsTheCubeAndItsOwnWriting) {
  EXPECT_EQ(parse_vertices(kCube).size(), 1u);
  EXPECT_EQ(format_vertices(parse_vertices(kCube)), kCube);
  EXPECT_EQ(parse_vertices(with(1, "\r\n 1 \r\n\r\n")).size(), 1u);  // blank lines, another system's line ends
  std::string open_end = kCube;
  open_end.pop_back();
  EXPECT_EQ(parse_vertices(open_end).size(), 1u);
}

TEST(Vertices, WritesEachDigit) {
  test::RandomValues random(1);
  std::vector<Corners> regions;
  for (int i = 0; i < 50; ++i) {
    regions.push_back(Parallelepiped(random.vector(1), Vector3(0.1, 0, 0), Vector3(0, 0.1, 0.01), Vector3(0, 0, 0.1))
                          .moved(random.pose(1))
                          .corners());
  }
  EXPECT_EQ(parse_vertices(format_vertices(regions)), regions);
}

TEST(Vertices, ScaleThenRotationThenOffset) {
  VerticesFileOptions options;
  options.scale = 0.001;
  options.marker_T_file = {Quaternion(Eigen::AngleAxisd(M_PI_2, Vector3::UnitZ())), Vector3(0.02, 0, 0)};
  std::string text = kCube;
  for (std::size_t at = 2; (at = text.find('1', at)) != std::string::npos; at += 3) {
    text.replace(at, 1, "100");
  }
  const Corners corners = parse_vertices(text, options).at(0);
  EXPECT_NEAR((corners[1] - Vector3(0.02, 0.1, 0)).norm(), 0.0, 1e-15);
}

TEST(Vertices, RefusalsNameLineValueAndBound) {
  expect_refusal("", "line 1: the file is empty");
  expect_refusal("\n\n", "the file is empty");
  expect_refusal(with(1, "0\n"), "line 1: number of regions = '0': must be a whole number in [1, 100000]");
  expect_refusal(with(1, "-1\n"), "line 1");
  expect_refusal(with(1, "1.0\n"), "line 1");
  expect_refusal(with(1, "100001\n"), "[1, 100000]");
  expect_refusal(with(1, "99999999999999999999999\n"), "line 1");
  expect_refusal(with(1, "1 2\n"), "line 1");
  expect_refusal(with(3, "nan 0 0\n"), "line 3: x = 'nan': must be finite");
  expect_refusal(with(3, "0 inf 0\n"), "line 3: y = 'inf': must be finite");
  expect_refusal(with(3, "0 0 1e999\n"), "line 3: z = '1e999'");
  expect_refusal(with(3, "0 0 1,5\n"), "line 3: z = '1,5': must be a number");
  expect_refusal(with(3, "0 0\n"), "line 3: '0 0': must be three numbers 'x y z', has 2");
  expect_refusal(with(3, "0 0 0 0\n"), "has more");
  expect_refusal(with(9, ""), "line 9: the file ends: region 1 of 1 has 7 corners, must have 8");
  expect_refusal(kCube + std::string("1 1 1\n"), "line 10: '1 1 1' after the last of 1 regions");
  expect_refusal(with(8, "1 1 1.1\n"), "line 2: region 1: v6 is 0.1 m from where");
  expect_refusal(with(6, "0 0 0\n"), "zero volume");
  expect_refusal(with(1, "2\n"), "line 10: the file ends: region 2 of 2 has 0 corners");
}

TEST(Vertices, CountDoesNotDecideMemory) {
  VerticesFileOptions options;
  options.max_count = ~std::uint64_t{0};
  EXPECT_NE(refusal(with(1, "18446744073709551615\n"), options), "");
}

TEST(Vertices, OptionsAreChecked) {
  VerticesFileOptions options;
  for (const double scale : {0.0, -1.0, test::kNan, test::kInf}) {
    options.scale = scale;
    EXPECT_THROW(parse_vertices(kCube, options), ConfigError);
  }
}

}  // namespace
}  // namespace saras
