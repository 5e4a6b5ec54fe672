#include "jpeg.hpp"

#include <turbojpeg.h>

#include <memory>

namespace saras_ros1 {

std::vector<std::uint8_t> jpeg(const saras::ImageView& bgr, int quality) {
  struct Destroy {
    void operator()(void* handle) const { tjDestroy(handle); }
  };
  const std::unique_ptr<void, Destroy> encoder(tjInitCompress());
  std::vector<std::uint8_t> bytes;
  if (!encoder || bgr.width < 1 || bgr.height < 1) {
    return bytes;
  }
  bytes.resize(tjBufSize(bgr.width, bgr.height, TJSAMP_420));
  unsigned char* out = bytes.data();
  auto size = static_cast<unsigned long>(bytes.size());  // NOLINT(google-runtime-int): TurboJPEG's own type
  const int done = tjCompress2(encoder.get(), bgr.data, bgr.width, static_cast<int>(bgr.stride), bgr.height, TJPF_BGR,
                               &out, &size, TJSAMP_420, quality, TJFLAG_NOREALLOC);
  bytes.resize(done == 0 ? size : 0);
  return bytes;
}

}  // namespace saras_ros1
