// What is known at each vertex of a mesh, kept up to date while the samples come: neighbouring vertices share one local
// model, and only where samples have come, or the mesh has moved, is asked again.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "saras/model/hash_grid.hpp"
#include "saras/model/local_model.hpp"

namespace saras {

struct VertexMapConfig {
  double patch_m = 1.5e-3;         ///< edge of the cells whose vertices share a local model [m]
  double normal_cosine = 0.9;      ///< vertices whose normals differ by more share none (folds, thin walls)
  double move_tolerance_m = 5e-5;  ///< a vertex that has moved no further since it was asked is not asked again [m]
  void validate() const;           ///< throws ConfigError
};

/// NaN with an infinite deviation: not known.
struct VertexEstimate {
  double stiffness_N_m = std::numeric_limits<double>::quiet_NaN();
  double stiffness_std_N_m = std::numeric_limits<double>::infinity();
};

/// One thread's: neither touch() nor refresh() allocates after the first pass over the mesh.
class VertexMap {
 public:
  /// vertices [m] and outward unit normals, as many; model_radius_m: LocalModelConfig::radius_m. Throws ConfigError.
  VertexMap(const std::vector<Vector3>& vertices, const std::vector<Vector3>& normals, double model_radius_m,
            const VertexMapConfig& config = {});

  /// A sample has come within slack_m of the position: out of date is where it may count among the nearest ones.
  void touch(const Vector3& position, double slack_m);
  /// Everything is out of date: other hyper-parameters.
  void touch_all();
  /// The mesh has been laid anew; the patches stay as they are. As many as before.
  void move(const std::vector<Vector3>& vertices, const std::vector<Vector3>& normals);

  /// Asks again what is out of date: all patches within near_m of the tips, then of the others those that have waited
  /// longest, at most `more` of them. Returns the vertices that were asked, those near the tips first.
  struct Refreshed {
    std::vector<std::int32_t> vertices;
    std::size_t near = 0;  ///< of the vertices
    int longest_wait = 0;  ///< refreshes that one of them was out of date
  };
  const Refreshed& refresh(const HashGrid& grid, LocalModel& workspace, const std::vector<Vector3>& tips, double near_m,
                           int more);

  const std::vector<VertexEstimate>& estimates() const { return estimates_; }
  int patches() const { return static_cast<int>(patches_.size()); }
  /// Patches that are out of date.
  int stale() const { return static_cast<int>(waiting_.size()); }

 private:
  struct Patch {
    std::vector<std::int32_t> vertices;
    Vector3 center = Vector3::Zero();
    Vector3 normal = Vector3::Zero();
    double radius_m = 0.0;  ///< of the vertices about the centre
    double reach_m = 0.0;   ///< of the samples that its model is made of, across the surface
    int since = 0;          ///< refreshes before it went out of date
    bool stale = false;
  };
  void settle(Patch& patch);
  void mark(std::int32_t patch);
  void ask(const HashGrid& grid, LocalModel& workspace, std::int32_t patch);

  VertexMapConfig config_;
  double model_radius_m_;
  std::vector<Vector3> vertices_;
  std::vector<Vector3> normals_;
  std::vector<Vector3> asked_at_;
  std::vector<Patch> patches_;
  std::vector<std::int32_t> patch_of_;
  std::vector<VertexEstimate> estimates_;
  std::vector<std::int32_t> waiting_;  ///< in the order in which they went out of date
  int refreshes_ = 0;
  Refreshed refreshed_;
};

}  // namespace saras
