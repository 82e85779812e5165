#pragma once
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "view/display_codes.h"
#include "view/edited_scene.h"
#include "view/view_state.h"

namespace trueshade::viewer {

/// One picture as it was drawn.
struct DrawnPicture {
  ViewState state;    ///< what was asked for
  Pipeline pipeline;  ///< what it was drawn by
  Camera camera;      ///< where it was seen from
  Frame frame;
  std::vector<Light> lights;    ///< as they stand; empty of more than kMostLights
  std::vector<uint32_t> words;  ///< of DisplayCodes::convert(); read_words() reads them
  double draw_ms = 0.0, convert_ms = 0.0;

  static constexpr size_t kMostLights = 20000;
};

/// Draws pictures on a thread that FrameMaker owns. Each picture shows the state that was asked for last; states that
/// were asked for while a picture was drawn are skipped. Only that thread touches the scene. Another thread that wants
/// to read the scene sends a job, and the job posts its answer as mail.
class FrameMaker {
 public:
  /// `news` is called in the maker's thread whenever there is a picture, a hash or mail.
  FrameMaker(std::unique_ptr<EditedScene> scene, const Execution& execution, std::function<void()> news);
  ~FrameMaker();  ///< carries out the jobs that wait, and ends
  FrameMaker(const FrameMaker&) = delete;
  FrameMaker& operator=(const FrameMaker&) = delete;

  void ask(const ViewState& state);

  using Job = std::function<void(EditedScene& scene, const DrawnPicture& picture)>;
  /// Calls the job in the maker's thread, with the scene and the picture of the state asked for last, or of a later
  /// one. What it throws comes as a problem; so does that there is no picture of such a state.
  void send(Job job);
  /// Puts another scene in the place of this one, once `load` has made it; the newest state is drawn anew.
  using Loader = std::function<std::unique_ptr<EditedScene>()>;
  void replace(Loader load);

  /// Calls a task in the maker's thread, before pictures that wait. What it throws comes as a problem.
  void work_on(std::function<void()> task);

  using Mail = std::function<void()>;
  void post(Mail mail);  ///< from the maker's thread; to be called by who takes it
  std::vector<Mail> take_mail();

  std::shared_ptr<const DrawnPicture> newest() const;  ///< null before the first
  /// The picture's hash, 64 hex digits, which is found once nothing else has been asked for a moment; else empty.
  std::string hash_of(uint64_t revision) const;
  std::optional<std::string> take_problem();  ///< what went wrong first since the last call, one line
  bool is_refused(uint64_t revision) const;   ///< whether that state was tried, and could not be drawn
  bool busy() const;                          ///< whether anything waits or is at work

 private:
  struct WaitingJob {
    uint64_t revision;
    Job job;
  };
  void work();
  void draw(ViewState state);
  void run(const std::function<void()>& task);
  bool ready_job() const;
  void carry_out(const WaitingJob& next, const std::shared_ptr<const DrawnPicture>& picture);
  void load_next();

  std::unique_ptr<EditedScene> scene_;  // of the maker's thread alone
  DisplayCodes codes_;
  const Execution execution_;
  const std::function<void()> news_;

  mutable std::mutex mutex_;
  std::condition_variable change_;
  std::optional<ViewState> asked_;
  ViewState last_asked_;
  std::deque<WaitingJob> jobs_;
  std::deque<std::function<void()>> tasks_;
  std::optional<Loader> loader_;
  std::vector<Mail> mail_;
  std::shared_ptr<const DrawnPicture> drawn_;
  uint64_t hashed_revision_ = 0, tried_revision_ = 0;  // tried: drawn, or refused
  bool is_current_ = false;                            // the scene is as drawn_ shows it
  std::string hash_;
  std::optional<std::string> problem_;
  bool ends_ = false, at_work_ = false;
  std::thread thread_;
};

}  // namespace trueshade::viewer
