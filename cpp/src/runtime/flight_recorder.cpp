#include "saras/runtime/flight_recorder.hpp"

#include <array>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "saras/pipeline/words.hpp"
#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

constexpr std::array<char, 8> kMagic{'S', 'A', 'R', 'A', 'S', 'F', 'L', 'T'};
constexpr std::uint64_t kVersion = 1;
constexpr std::uint64_t kChunkMark = 0x4b4e5548'43464c54;  // where a chunk begins
constexpr std::size_t kReasonWords = 64;

template <class T>
std::size_t word_count() {
  Words words;
  append_words(words, T{});
  return words.size();
}

void append_tick(Words& words, const FlightTick& tick) {
  WordWriter writer(words);
  FlightTick& t = const_cast<FlightTick&>(tick);
  writer(t.index, t.now_ns, t.stamp_ns, t.dt_s, t.input, t.output);
}

void read_tick(WordReader& reader, FlightTick& t) { reader(t.index, t.now_ns, t.stamp_ns, t.dt_s, t.input, t.output); }

/// Version, and the sizes of what follows: a record of another layout is refused, not misread.
Words header() {
  return {kVersion, word_count<PipelineInput>(), word_count<PipelineOutput>(), word_count<PipelineConfig>()};
}

}  // namespace

FlightRecorder::FlightRecorder(std::size_t chunks, std::size_t ticks_per_chunk) {
  validate::in_range("chunks", static_cast<double>(chunks), 3, 100000);
  validate::in_range("ticks_per_chunk", static_cast<double>(ticks_per_chunk), 1, 1000000);
  for (std::size_t i = 0; i < chunks; ++i) {
    chunks_.push_back(std::make_unique<Chunk>());
    chunks_.back()->ticks.resize(ticks_per_chunk);
  }
}

bool FlightRecorder::enter_next() noexcept {
  const std::size_t next = (current_ + 1) % chunks_.size();
  int nobody = kNobody;
  if (!chunks_[next]->owner.compare_exchange_strong(nobody, kLoop, std::memory_order_acq_rel)) {
    return false;
  }
  chunks_[next]->count = 0;
  current_ = next;
  holds_chunk_ = true;
  newest_.store(next, std::memory_order_release);
  return true;
}

FlightTick* FlightRecorder::begin(const Pipeline& before) noexcept {
  const bool full = holds_chunk_ && chunks_[current_]->count == chunks_[current_]->ticks.size();
  if (full || close_requested_.load(std::memory_order_acquire)) {
    close();
  }
  if (!holds_chunk_ && !enter_next()) {
    left_out_.store(left_out_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    return nullptr;
  }
  Chunk& chunk = *chunks_[current_];
  if (chunk.count == 0) {
    chunk.state = before.state();
  }
  return &chunk.ticks[chunk.count];
}

void FlightRecorder::commit() noexcept { ++chunks_[current_]->count; }

void FlightRecorder::close() noexcept {
  if (holds_chunk_) {
    chunks_[current_]->owner.store(kNobody, std::memory_order_release);
    holds_chunk_ = false;
  }
  close_requested_.store(false, std::memory_order_release);
}

std::size_t FlightRecorder::bytes() const noexcept {
  return chunks_.size() * (sizeof(Chunk) + chunks_[0]->ticks.size() * sizeof(FlightTick));
}

std::uint64_t FlightRecorder::write(const std::string& path, const PipelineConfig& config, const std::string& reason) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  if (!file) {
    throw Error("flight record " + path + ": " + std::strerror(errno));
  }
  Words words;
  const auto flush = [&] {
    file.write(reinterpret_cast<const char*>(words.data()),
               static_cast<std::streamsize>(words.size() * sizeof(std::uint64_t)));
    words.clear();
  };
  file.write(kMagic.data(), kMagic.size());
  words = header();
  std::array<char, kReasonWords * sizeof(std::uint64_t)> text{};
  std::strncpy(text.data(), reason.c_str(), text.size() - 1);
  words.resize(words.size() + kReasonWords);
  std::memcpy(words.data() + words.size() - kReasonWords, text.data(), text.size());
  append_words(words, config);
  flush();

  std::uint64_t written = 0;
  std::uint64_t last_index = 0;
  const std::size_t begin = newest_.load(std::memory_order_acquire) + 1;
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    Chunk& chunk = *chunks_[(begin + i) % chunks_.size()];
    int nobody = kNobody;
    if (!chunk.owner.compare_exchange_strong(nobody, kWriter, std::memory_order_acq_rel)) {
      continue;  // the loop is in it
    }
    // The loop may have lapped this thread: what is newer than its place is left out.
    if (chunk.count > 0 && (written == 0 || chunk.ticks[0].index > last_index)) {
      words.push_back(kChunkMark);
      words.push_back(chunk.count);
      append_words(words, chunk.state);
      for (std::size_t k = 0; k < chunk.count; ++k) {
        append_tick(words, chunk.ticks[k]);
      }
      written += chunk.count;
      last_index = chunk.ticks[chunk.count - 1].index;
    }
    chunk.owner.store(kNobody, std::memory_order_release);
    flush();
  }
  file.close();
  if (!file) {
    throw Error("flight record " + path + ": not written whole: " + std::strerror(errno));
  }
  return written;
}

FlightRecord read_flight(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) {
    throw Error("flight record " + path + ": " + std::strerror(errno));
  }
  const auto size = static_cast<std::size_t>(file.tellg());
  std::array<char, 8> magic{};
  file.seekg(0);
  file.read(magic.data(), magic.size());
  if (size < magic.size() || magic != kMagic || size % sizeof(std::uint64_t) != 0) {
    throw ProtocolError("flight record " + path + ": no flight record, or cut short");
  }
  Words words(size / sizeof(std::uint64_t) - 1);
  file.read(reinterpret_cast<char*>(words.data()), static_cast<std::streamsize>(words.size() * sizeof(std::uint64_t)));
  const Words expected = header();
  if (words.size() < expected.size() + kReasonWords || !std::equal(expected.begin(), expected.end(), words.begin())) {
    throw ProtocolError("flight record " + path + ": of another version of this program: must be version " +
                        std::to_string(kVersion) + " with the same fields");
  }
  FlightRecord record;
  std::array<char, kReasonWords * sizeof(std::uint64_t)> text{};
  std::memcpy(text.data(), words.data() + expected.size(), text.size() - 1);
  record.reason = text.data();
  const std::size_t begin = expected.size() + kReasonWords;
  WordReader reader(words.data() + begin, words.size() - begin);
  reader(record.config);
  const std::size_t tick_words = word_count<PipelineInput>() + word_count<PipelineOutput>() + 4;
  while (reader.left() > 0) {
    std::uint64_t mark = 0;
    std::uint64_t count = 0;
    reader(mark, count);
    if (mark != kChunkMark || count == 0 || count > reader.left() / tick_words) {
      throw ProtocolError("flight record " + path + ": damaged, or cut short");
    }
    FlightRecord::Chunk& chunk = record.chunks.emplace_back();
    reader(chunk.state);
    chunk.ticks.resize(count);
    for (FlightTick& tick : chunk.ticks) {
      read_tick(reader, tick);
    }
  }
  return record;
}

FlightReplay replay_flight(const FlightRecord& record) {
  FlightReplay replay;
  Pipeline pipeline(record.config);
  std::uint64_t last_index = 0;
  Words recorded;
  Words reached;
  for (const FlightRecord::Chunk& chunk : record.chunks) {
    if (replay.ticks == 0 || chunk.ticks[0].index != last_index + 1) {
      pipeline.reset(chunk.state);
    } else {
      recorded.clear();
      reached.clear();
      append_words(recorded, chunk.state);
      append_words(reached, pipeline.state());
      ++replay.states;
      replay.states_exact += recorded == reached ? 1 : 0;
    }
    for (const FlightTick& tick : chunk.ticks) {
      recorded.clear();
      reached.clear();
      append_words(recorded, tick.output);
      append_words(reached, pipeline.step(tick.input, tick.dt_s));
      const bool exact = recorded == reached;
      ++replay.ticks;
      replay.exact += exact ? 1 : 0;
      if (!exact && replay.first_difference < 0) {
        replay.first_difference = static_cast<std::int64_t>(tick.index);
      }
      last_index = tick.index;
    }
  }
  return replay;
}

}  // namespace saras
