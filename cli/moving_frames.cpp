#include "cli/moving_frames.h"

#include <stdexcept>
#include <string>

#include "bench/moving_scene.h"
#include "core/threads/clock.h"

namespace trueshade {
namespace {

/// A sequence that is drawn frame by frame, timed from outside.
class MovingFrames {
 public:
  MovingFrames(Scene& scene, const PreparedScene& prepared, const Pipeline& pipeline, const Execution& execution)
      : moving_(scene), prepared_(prepared), pipeline_(pipeline), execution_(execution) {}

  double draw_next() {
    const double start = now_ms();
    moving_.move_to(++step_);
    return timed(start, Frames::next);
  }

  double draw_again() { return timed(now_ms(), Frames::again); }

  /// Draws the last frame by a scene that is prepared anew.
  void check_prepared_anew() const {
    const PreparedScene anew(prepared_.scene());
    if (image_hash(render_frame(anew, pipeline_, execution_).color) != hash_)
      throw std::runtime_error("a frame of a sequence comes out otherwise where it is drawn alone");
  }

 private:
  enum class Frames : uint8_t { next, again };

  double timed(double start, Frames frames) {
    const Frame frame = render_frame(prepared_, pipeline_, execution_);
    const double ms = now_ms() - start;
    const std::string hash = image_hash(frame.color);
    if (frames == Frames::again && hash != hash_)
      throw std::runtime_error("a frame of a sequence came out otherwise when it was drawn again");
    hash_ = hash;
    return ms;
  }

  MovingScene moving_;
  const PreparedScene& prepared_;
  const Pipeline& pipeline_;
  const Execution& execution_;
  int step_ = 0;
  std::string hash_;  // of the last frame
};

}  // namespace

MovingTime moving_time(Scene& scene, const PreparedScene& prepared, const Pipeline& pipeline,
                       const Execution& execution) {
  MovingFrames frames(scene, prepared, pipeline, execution);
  const Contender contenders[] = {{"trueshade", "next frame", [&frames] { return frames.draw_next(); }},
                                  {"trueshade", "the same again", [&frames] { return frames.draw_again(); }}};
  std::vector<Timing> timings = contest(contenders, {});
  frames.draw_next();
  frames.check_prepared_anew();
  return {std::move(timings[0]), std::move(timings[1])};
}

}  // namespace trueshade
