// Values as 64-bit words, in the order of fields(): exact to the bit, NaN included.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "saras/pipeline/fields.hpp"
#include "saras/spatial/errors.hpp"

namespace saras {

using Words = std::vector<std::uint64_t>;

namespace detail {

/// Takes a value apart down to numbers; Self::number(T&) writes or reads one.
template <class Self>
class WordArchive {
 public:
  /// Whether values are filled from words: what is no field by itself is then made of what was read.
  static constexpr bool reads() { return Self::kReads; }
  template <class... T>
  void operator()(T&&... values) {
    (take(values), ...);
  }

 private:
  template <class T>
  void take(T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      self().number(value);
    } else if constexpr (std::is_same_v<T, ChannelArray>) {
      auto columns = static_cast<std::uint64_t>(value.cols());
      self().number(columns);
      if (columns > static_cast<std::uint64_t>(kMaxTankChannels)) {
        throw ProtocolError("flight record: " + std::to_string(columns) + " tank channels: must be at most " +
                            std::to_string(kMaxTankChannels));
      }
      value.resize(6, static_cast<Eigen::Index>(columns));
      coefficients(value);
    } else if constexpr (std::is_base_of_v<Eigen::MatrixBase<T>, T>) {
      coefficients(value);
    } else {
      compound(value);
    }
  }
  template <class T>
  void coefficients(T& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) {
      self().number(matrix.data()[i]);
    }
  }
  template <class T>
  void compound(T& value) {
    fields(*this, value);
  }
  template <class T, std::size_t N>
  void compound(std::array<T, N>& values) {
    for (T& value : values) {
      take(value);
    }
  }
  template <class T>
  void compound(std::vector<T>& values) {
    auto size = static_cast<std::uint64_t>(values.size());
    self().number(size);
    self().fit(size);
    values.resize(size);
    for (T& value : values) {
      take(value);
    }
  }
  Self& self() { return static_cast<Self&>(*this); }
};

}  // namespace detail

/// Appends to a vector of words.
class WordWriter : public detail::WordArchive<WordWriter> {
 public:
  static constexpr bool kReads = false;
  explicit WordWriter(Words& words) : words_(words) {}
  template <class T>
  void number(T& value) {
    std::uint64_t word = 0;
    if constexpr (std::is_floating_point_v<T>) {
      const auto wide = static_cast<double>(value);
      std::memcpy(&word, &wide, sizeof(word));
    } else if constexpr (std::is_same_v<T, char>) {
      word = static_cast<unsigned char>(value);  // of a name
    } else {
      word = static_cast<std::uint64_t>(value);
    }
    words_.push_back(word);
  }
  void fit(std::uint64_t) {}

 private:
  Words& words_;
};

/// Reads from words; throws ProtocolError when they end too early.
class WordReader : public detail::WordArchive<WordReader> {
 public:
  static constexpr bool kReads = true;
  WordReader(const std::uint64_t* words, std::size_t size) : next_(words), left_(size) {}
  template <class T>
  void number(T& value) {
    fit(1);
    if constexpr (std::is_floating_point_v<T>) {
      double wide = 0.0;
      std::memcpy(&wide, next_, sizeof(wide));
      value = static_cast<T>(wide);
    } else {
      value = static_cast<T>(*next_);
    }
    ++next_;
    --left_;
  }
  /// Refuses a count that the rest cannot hold.
  void fit(std::uint64_t words) const {
    if (words > left_) {
      throw ProtocolError("flight record: ends within a value");
    }
  }
  std::size_t left() const { return left_; }

 private:
  const std::uint64_t* next_;
  std::size_t left_;
};

template <class T>
void append_words(Words& words, const T& value) {
  WordWriter writer(words);
  writer(const_cast<T&>(value));  // the writer only reads
}

}  // namespace saras
