// Halves of a picture, and its JPEG.
#include "picture.hpp"

#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <numeric>
#include <random>
#include <vector>

#include "jpeg.hpp"
#include "saras/spatial/errors.hpp"

namespace saras_ros1 {
namespace {

struct Drawn {
  Drawn(int width, int height, std::size_t padding)
      : bytes((static_cast<std::size_t>(width) * 3 + padding) * static_cast<std::size_t>(height)) {
    picture.pixels.data = bytes.data();
    picture.pixels.width = width;
    picture.pixels.height = height;
    picture.pixels.stride = static_cast<std::size_t>(width) * 3 + padding;
    picture.taken_ns = 7;
  }
  std::vector<std::uint8_t> bytes;
  Picture picture;
};

const std::uint8_t* at(const Picture& picture, int x, int y) {
  return picture.pixels.data + static_cast<std::size_t>(y) * picture.pixels.stride + static_cast<std::size_t>(x) * 3;
}

TEST(Halves, TogetherAreThePicture) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> side(1, 20), byte(0, 255), padding(0, 5);
  for (int draw = 0; draw < 2000; ++draw) {
    Drawn drawn(2 * side(random), 2 * side(random), static_cast<std::size_t>(padding(random)));
    for (std::uint8_t& value : drawn.bytes) {
      value = static_cast<std::uint8_t>(byte(random));
    }
    const saras::ImageView& whole = drawn.picture.pixels;
    for (const Layout layout : {Layout::kSideBySide, Layout::kTopBottom}) {
      const auto eyes = halves(drawn.picture, layout);
      const int width = eyes[0].pixels.width, height = eyes[0].pixels.height;
      ASSERT_EQ(width, layout == Layout::kSideBySide ? whole.width / 2 : whole.width);
      ASSERT_EQ(height, layout == Layout::kSideBySide ? whole.height : whole.height / 2);
      for (int y = 0; y < whole.height; ++y) {
        for (int x = 0; x < whole.width; ++x) {
          const Picture& eye = eyes[layout == Layout::kSideBySide ? x >= width : y >= height];
          ASSERT_EQ(at(eye, x % width, y % height), at(drawn.picture, x, y));  // the same bytes, not copies
        }
      }
      EXPECT_EQ(eyes[0].taken_ns, 7);
      EXPECT_EQ(eyes[1].taken_ns, 7);
    }
  }
}

TEST(Halves, OddSideIsRefusedWithTheSize) {
  Drawn drawn(5, 4, 0);
  try {
    halves(drawn.picture, Layout::kSideBySide);
    FAIL();
  } catch (const saras::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("5x4"), std::string::npos);
  }
  EXPECT_NO_THROW(halves(drawn.picture, Layout::kTopBottom));
}

TEST(Jpeg, ColoursComeBack) {
  Drawn drawn(64, 48, 4);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const std::array<std::uint8_t, 3> bgr = {200, 40, 90};
      std::copy(bgr.begin(), bgr.end(), const_cast<std::uint8_t*>(at(drawn.picture, x, y)));
    }
  }
  const std::vector<std::uint8_t> bytes = jpeg(drawn.picture.pixels, 90);
  ASSERT_FALSE(bytes.empty());
  tjhandle decoder = tjInitDecompress();
  int width = 0, height = 0, subsampling = 0, space = 0;
  ASSERT_EQ(tjDecompressHeader3(decoder, bytes.data(), bytes.size(), &width, &height, &subsampling, &space), 0);
  ASSERT_EQ(width, 64);
  ASSERT_EQ(height, 48);
  std::vector<std::uint8_t> back(64 * 48 * 3);
  ASSERT_EQ(tjDecompress2(decoder, bytes.data(), bytes.size(), back.data(), 64, 0, 48, TJPF_BGR, 0), 0);
  tjDestroy(decoder);
  for (std::size_t i = 0; i < back.size(); i += 3) {
    EXPECT_NEAR(back[i], 200, 4);
    EXPECT_NEAR(back[i + 1], 40, 4);
    EXPECT_NEAR(back[i + 2], 90, 4);
  }
  EXPECT_TRUE(jpeg(saras::ImageView{}, 90).empty());
}

}  // namespace
}  // namespace saras_ros1
