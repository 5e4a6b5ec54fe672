#include "saras/overlay/canvas.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "saras/overlay/stroke_font.hpp"
#include "support/random_values.hpp"

namespace saras {
namespace {

constexpr int kWidth = 61, kHeight = 43;

struct Picture {
  explicit Picture(PixelFormat format, std::uint8_t value = 0)
      : stride(static_cast<std::size_t>(kWidth * channels(format)) + 5), bytes(stride * kHeight, value) {
    view = {bytes.data(), kWidth, kHeight, stride, format};
  }
  std::uint8_t at(int x, int y, int channel = 0) const {
    return bytes[static_cast<std::size_t>(y) * stride + static_cast<std::size_t>(x * channels(view.format) + channel)];
  }
  std::size_t stride;
  std::vector<std::uint8_t> bytes;
  ImageView view;
};

double distance_to_segment(const Pixel& p, const Pixel& a, const Pixel& b) {
  const Pixel d = b - a;
  const double share = d.squaredNorm() > 0.0 ? std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
  return (p - a - share * d).norm();
}

// Pixel by pixel: coverage = clamp(radius + 1/2 - distance).
TEST(Canvas, LinesAreWhatTheDefinitionSays) {
  test::RandomValues random(1);
  for (int i = 0; i < 3000; ++i) {
    Picture picture(PixelFormat::kMono8);
    Pixel a(random.uniform(-40, 100), random.uniform(-40, 80)), b(random.uniform(-40, 100), random.uniform(-40, 80));
    if (i % 5 == 0) {
      b.y() = a.y();
    } else if (i % 5 == 1) {
      b.x() = a.x();
    } else if (i % 5 == 2) {
      b = a;
    }
    const double radius = random.uniform(0.1, 9.0);
    draw_line(picture.view, a, b, radius, {0, 0, 0, 255});
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const double coverage = std::clamp(radius + 0.5 - distance_to_segment(Pixel(x, y), a, b), 0.0, 1.0);
        ASSERT_NEAR(picture.at(x, y), 255.0 * coverage, 1.6) << i << ": " << x << ", " << y;
      }
    }
  }
}

TEST(Canvas, EachFormatGetsItsBytes) {
  const Color color{10, 20, 30, 40};
  const struct {
    PixelFormat format;
    std::vector<int> expected;
  } cases[] = {{PixelFormat::kRgb8, {10, 20, 30}},
               {PixelFormat::kBgr8, {30, 20, 10}},
               {PixelFormat::kMono8, {40}},
               {PixelFormat::kRgba8, {10, 20, 30, 255}},
               {PixelFormat::kBgra8, {30, 20, 10, 255}}};
  for (const auto& c : cases) {
    Picture picture(c.format, 200);
    draw_disc(picture.view, {30, 20}, 5.0, color);
    for (std::size_t channel = 0; channel < c.expected.size(); ++channel) {
      EXPECT_EQ(picture.at(30, 20, static_cast<int>(channel)), c.expected[channel]);
      EXPECT_EQ(picture.at(3, 20, static_cast<int>(channel)), 200);
    }
  }
}

TEST(Canvas, BlendingIsRoundedBothWays) {
  for (const int background : {0, 25, 128, 255}) {
    for (const int color : {0, 25, 140, 255}) {
      for (int coverage = 0; coverage <= 255; ++coverage) {
        std::uint8_t pixel = static_cast<std::uint8_t>(background);
        blend(&pixel, 1, {{static_cast<std::uint8_t>(color), 0, 0, 255}}, coverage);
        ASSERT_NEAR(pixel, background + (color - background) * coverage / 255.0, 0.51);
      }
    }
  }
}

TEST(Canvas, EncodingsByName) {
  PixelFormat format = PixelFormat::kMono8;
  EXPECT_TRUE(parse_encoding("bgra8", format));
  EXPECT_EQ(format, PixelFormat::kBgra8);
  for (const char* other : {"", "bgr", "mono16", "bayer_rggb8", "BGR8", "yuv422"}) {
    EXPECT_FALSE(parse_encoding(other, format)) << other;
    EXPECT_EQ(format, PixelFormat::kBgra8);
  }
}

TEST(Canvas, NothingIsDrawnForBadNumbers) {
  for (const double bad : {test::kNan, test::kInf, -test::kInf, 1e7}) {
    for (int field = 0; field < 5; ++field) {
      double numbers[5] = {5, 5, 30, 30, 3};
      numbers[field] = bad;
      Picture picture(PixelFormat::kBgr8, 9);
      draw_line(picture.view, {numbers[0], numbers[1]}, {numbers[2], numbers[3]}, numbers[4], {255, 255, 255, 255});
      EXPECT_EQ(picture.bytes, std::vector<std::uint8_t>(picture.bytes.size(), 9));
    }
  }
}

TEST(Canvas, BoxesAndTextStayInTheImage) {
  const StrokeFont font(12);
  for (int x = -200; x <= 200; x += 7) {
    for (int y = -100; y <= 100; y += 7) {
      Picture picture(PixelFormat::kBgr8, 100);
      darken(picture.view, x, y, 50, 20, 128);
      font.draw(picture.view, x, y, "PSM1 -12.3 mm ?", {255, 255, 255, 255});
      for (int row = 0; row < kHeight; ++row) {
        for (std::size_t pad = static_cast<std::size_t>(kWidth) * 3; pad < picture.stride; ++pad) {
          ASSERT_EQ(picture.bytes[static_cast<std::size_t>(row) * picture.stride + pad], 100);
        }
      }
    }
  }
}

TEST(StrokeFont, EveryLetterIsAnother) {
  const StrokeFont font(20);
  const std::string letters = "123456789ABCDEFGHIJKLMNOPQRSTUVWXYZm.-+?!/:";
  std::vector<std::vector<std::uint8_t>> seen;
  for (const char letter : letters) {
    Picture picture(PixelFormat::kMono8);
    font.draw(picture.view, 8, 8, std::string(1, letter), {255, 255, 255, 255});
    for (const auto& other : seen) {
      EXPECT_NE(picture.bytes, other) << letter;
    }
    seen.push_back(picture.bytes);
  }
  Picture gap(PixelFormat::kMono8);
  font.draw(gap.view, 8, 8, " \x01\xff", {255, 255, 255, 255});
  EXPECT_EQ(gap.bytes, std::vector<std::uint8_t>(gap.bytes.size(), 0));
}

TEST(ShortText, Millimetres) {
  const struct {
    double length_m;
    const char* text;
  } cases[] = {{0.0123, "12.3"},  {0.0, "0.0"},       {-0.00125, "-1.3"}, {0.0999, "99.9"}, {0.09996, "100"},
               {0.1234, "123"},   {1.5, "1500"},      {-0.00001, "0.0"},  {0.00005, "0.1"}, {test::kNan, "?"},
               {test::kInf, "?"}, {-test::kInf, "?"}, {1e30, "?"},        {-0.25, "-250"}};
  for (const auto& c : cases) {
    ShortText text;
    EXPECT_EQ(text.append_mm(c.length_m).view(), c.text) << c.length_m;
  }
}

TEST(ShortText, WhatDoesNotFitIsCutOff) {
  ShortText text;
  for (int i = 0; i < 20; ++i) {
    text += "12345678";
  }
  EXPECT_EQ(text.view().size(), 64u);
}

}  // namespace
}  // namespace saras
