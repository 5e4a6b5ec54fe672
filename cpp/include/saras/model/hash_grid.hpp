// Touch samples in a hash grid: bounded memory, and neighbours at a cost that does not grow with the session.
//
// A cell keeps a few places. A sample that comes near one of them is merged into it (weighted means of position and
// force), so that a million samples are as many places as there is touched tissue. The mean of a function that is
// linear over the cell is its value at the mean position, and the noise of a mean of w samples is that of one / sqrt w.
#pragma once

#include <cstdint>
#include <vector>

#include "saras/spatial/types.hpp"

namespace saras {

struct HashGridConfig {
  double cell_m = 1.5e-3;     ///< edge of a cell [m]
  int samples_per_cell = 2;   ///< places in a cell; further samples are merged
  int max_cells = 20000;      ///< then the cell that was touched longest ago is forgotten
  double max_weight = 100.0;  ///< of a place; above it the oldest part is forgotten, and the noise falls no further
  void validate() const;      ///< throws ConfigError
  /// Most places that HashGrid::within can find.
  int candidates_within(double radius_m) const noexcept;
};

/// What a place knows: the mean of the samples merged into it.
struct TouchSample {
  Vector3 position = Vector3::Zero();  ///< of the tip, base frame [m]
  Vector3 force = Vector3::Zero();     ///< that the tool exerts on the tissue, base frame [N]
  double speed_m_s = 0.0;              ///< of the tip along its force: > 0 while it presses; 0: not known
  double weight = 0.0;                 ///< samples in the mean; 0: the place is free
};

class HashGrid {
 public:
  /// Allocates all it will ever use. Throws ConfigError.
  explicit HashGrid(HashGridConfig config = {});

  /// Greatest |coordinate| that a cell's number holds.
  double reach_m() const { return config_.cell_m * kGreatestIndex; }
  /// Number of the place that took the sample; -1: not finite or beyond reach_m().
  int insert(const Vector3& position, const Vector3& force, double speed_m_s = 0.0) noexcept;
  /// Numbers of the used places within radius_m of the point, at most `room`, in no order. When more lie there, those
  /// of the cells visited first: give as much room as config().candidates_within().
  int within(const Vector3& point, double radius_m, int* places, int room) const noexcept;
  /// Forgets the cells whose centres lie within radius_m of the point.
  void forget(const Vector3& point, double radius_m) noexcept;
  void clear() noexcept;

  const TouchSample& place(int number) const { return samples_[static_cast<std::size_t>(number)]; }
  /// Places that hold samples.
  int places() const { return places_; }
  int cells() const { return cells_used_; }
  /// Cells forgotten for want of room.
  std::uint64_t evicted() const { return evicted_; }
  /// Samples taken since construction or clear().
  std::uint64_t taken() const { return taken_; }
  /// Numbers of all used places.
  std::vector<int> used() const;
  const HashGridConfig& config() const { return config_; }

 private:
  static constexpr double kGreatestIndex = 1 << 20;
  using Index = Eigen::Matrix<std::int32_t, 3, 1>;
  struct Cell {
    Index index = Index::Zero();
    std::int32_t next = -1;   ///< in the same bucket, or in the list of free cells
    std::int32_t newer = -1;  ///< by the time of the last touch
    std::int32_t older = -1;
    bool used = false;
  };
  Index index_of(const Vector3& position) const noexcept;
  std::int32_t& bucket(const Index& index) noexcept;
  std::int32_t find(const Index& index) const noexcept;
  std::int32_t take_cell(const Index& index) noexcept;
  void release(std::int32_t cell) noexcept;
  void touch(std::int32_t cell) noexcept;
  void unlink(std::int32_t cell) noexcept;

  HashGridConfig config_;
  std::vector<std::int32_t> buckets_;
  std::vector<Cell> cells_;
  std::vector<TouchSample> samples_;  ///< samples_per_cell each
  std::int32_t free_ = 0;
  std::int32_t newest_ = -1;
  std::int32_t oldest_ = -1;
  int places_ = 0;
  int cells_used_ = 0;
  std::uint64_t evicted_ = 0;
  std::uint64_t taken_ = 0;
};

}  // namespace saras
