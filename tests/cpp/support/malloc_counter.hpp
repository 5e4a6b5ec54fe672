// Counts heap allocations within a scope, by overriding malloc and its kin around glibc's own.
//
// Include it in exactly one source file of a test executable: it defines malloc. operator new ends in
// malloc too, so it is counted. With a sanitizer, which overrides malloc itself, nothing is counted and
// can_count is false.
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdlib>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define SARAS_MALLOC_IS_TAKEN
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define SARAS_MALLOC_IS_TAKEN
#endif

namespace saras::test {

#ifdef SARAS_MALLOC_IS_TAKEN
inline constexpr bool can_count = false;
#else
inline constexpr bool can_count = true;
#endif

/// Allocations of this thread since construction.
class MallocCounter {
 public:
  MallocCounter() { count_ = 0, counting_ = true; }
  ~MallocCounter() { counting_ = false; }
  MallocCounter(const MallocCounter&) = delete;
  MallocCounter& operator=(const MallocCounter&) = delete;
  std::size_t count() const { return count_; }

  static void note() noexcept {
    if (counting_) {
      ++count_;
    }
  }

 private:
  static inline thread_local bool counting_ = false;
  static inline thread_local std::size_t count_ = 0;
};

}  // namespace saras::test

#ifndef SARAS_MALLOC_IS_TAKEN
extern "C" {

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* pointer, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  saras::test::MallocCounter::note();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  saras::test::MallocCounter::note();
  return __libc_calloc(count, size);
}
void* realloc(void* pointer, std::size_t size) {
  saras::test::MallocCounter::note();
  return __libc_realloc(pointer, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  saras::test::MallocCounter::note();
  return __libc_memalign(alignment, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  saras::test::MallocCounter::note();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** result, std::size_t alignment, std::size_t size) {
  saras::test::MallocCounter::note();
  *result = __libc_memalign(alignment, size);
  return *result ? 0 : ENOMEM;
}

}  // extern "C"
#endif
