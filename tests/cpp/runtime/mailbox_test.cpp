#include "saras/runtime/mailbox.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

namespace saras {
namespace {

struct Letter {
  std::array<std::uint64_t, 100> words{};
};

TEST(Mailbox, GivesTheNewestValueOnce) {
  Mailbox<int> box(7);
  EXPECT_FALSE(box.update());
  EXPECT_EQ(box.value(), 7);
  for (int i = 1; i < 10; ++i) {
    box.write(10 * i);
    box.write(i);
    EXPECT_TRUE(box.update());
    EXPECT_EQ(box.value(), i);
    EXPECT_FALSE(box.update());
    EXPECT_EQ(box.value(), i);
  }
}

// Run by script/sanitize thread as well: the sanitizer is the judge of the memory order.
TEST(Mailbox, ValuesAreWholeAndNeverGoBackwards) {
  constexpr std::uint64_t kLetters = 50000;
  Mailbox<Letter> box;
  std::thread writer([&box] {
    for (std::uint64_t n = 1; n <= kLetters; ++n) {
      box.draft().words.fill(n);
      box.publish();
    }
  });
  std::uint64_t last = 0;
  while (last < kLetters) {
    if (!box.update()) {
      std::this_thread::yield();
      continue;
    }
    const auto& words = box.value().words;
    ASSERT_TRUE(std::all_of(words.begin(), words.end(), [&](std::uint64_t word) { return word == words[0]; }));
    ASSERT_GT(words[0], last);
    last = words[0];
  }
  writer.join();
}

}  // namespace
}  // namespace saras
