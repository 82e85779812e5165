// How often a frame asks for memory once its thread has drawn one: what it hands out, and no more for a larger scene.
#include <atomic>
#include <cstdlib>
#include <new>

#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"

namespace {

std::atomic<bool> counting{false};
std::atomic<int> asked{0};
std::atomic<size_t> bytes{0};

void* allocate(size_t size, size_t alignment) {
  if (counting) ++asked, bytes += size;
  void* const memory = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(size_t size) { return allocate(size, __STDCPP_DEFAULT_NEW_ALIGNMENT__); }
void* operator new(size_t size, std::align_val_t alignment) { return allocate(size, size_t(alignment)); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, size_t, std::align_val_t) noexcept { std::free(memory); }

using namespace trueshade;

TEST_CASE("A frame after the first asks for the memory of its picture, and a few times more, whatever the scene") {
  for (const char* spec : {"builtin:city", "builtin:city,lights=10000", "builtin:sphere"}) {
    const Scene scene = load_scene(spec);
    const PreparedScene prepared(scene);
    for (const char* preset : {"light-volumes", "many-lights", "redsdk"})
      for (const int threads : {1, 3}) {
        Pipeline pipeline = *preset_pipeline(preset);
        pipeline.width = 320, pipeline.height = 256;
        const size_t picture = size_t(pipeline.width * pipeline.height * info(pipeline.target).bytes_per_texel());
        for (int frame = 0; frame < 6; ++frame) render_frame(prepared, pipeline, {.threads = threads});
        int least = 1000000;  // threads may meet a dearer tile than any before
        size_t least_bytes = 0;
        for (int frame = 0; frame < 6; ++frame) {
          asked = 0, bytes = 0, counting = true;
          const Frame drawn = render_frame(prepared, pipeline, {.threads = threads});
          counting = false;
          if (asked < least) least = asked, least_bytes = bytes;
        }
        INFO(spec << ", " << preset << ", " << threads << " threads: " << least << " times, " << least_bytes - picture
                  << " bytes beside the picture");
        CHECK(least <= 32);
        CHECK(least_bytes - picture <= 32768);
      }
  }
}
