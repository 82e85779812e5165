#pragma once
#include <memory>
#include <utility>

#include "raster/clusters/clusters.h"
#include "scene_cache/checked_file.h"

namespace trueshade {

/// Checks what a cluster is drawn with where it lies in the file; arrays in memory are left out.
class CheckedClusters : public ClusterSource {
 public:
  CheckedClusters(std::shared_ptr<const CheckedFile> file, size_t textures)
      : file_(std::move(file)), texture_is_checked_(textures) {}
  void check(const Scene& scene, const Instance& instance, const ClusteredMesh& mesh,
             const Cluster& cluster) const override;
  void check_for_camera(const Scene& scene) const override;
  void check_all() const override { file_->check_all(); }

 private:
  void check_texture(const Texture& texture, size_t index) const;
  void check_own_streams(const Mesh& mesh, std::span<const uint32_t> vertices) const;
  template <class T, class Vector>
  void check_part(const Array<T, Vector>& array, size_t first, size_t count) const {
    if (!array.owned()) file_->check(array.data() + first, count * sizeof(T));
  }

  std::shared_ptr<const CheckedFile> file_;
  mutable std::vector<std::atomic<bool>> texture_is_checked_;  ///< wholly
};

}  // namespace trueshade
