#include "view/frame_maker.h"

#include <chrono>
#include <exception>
#include <new>
#include <utility>

#include "cli/looks.h"
#include "core/error.h"

namespace trueshade::viewer {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kStill{120};  // without a new state before the hash is worth its time

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

PictureValues values_of(const Pipeline& pipeline) {
  const bool are_codes = pipeline.view != ImageView::lit || pipeline.post.encode == PostChain::Encode::srgb;
  return are_codes ? PictureValues::display_codes : PictureValues::of_target;
}

}  // namespace

FrameMaker::FrameMaker(std::unique_ptr<EditedScene> scene, const Execution& execution, std::function<void()> news)
    : scene_(std::move(scene)), execution_(execution), news_(std::move(news)), thread_([this] { work(); }) {}

FrameMaker::~FrameMaker() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  change_.notify_all();
  thread_.join();
}

void FrameMaker::ask(const ViewState& state) {
  {
    const std::lock_guard lock(mutex_);
    asked_ = last_asked_ = state;
  }
  change_.notify_all();
}

void FrameMaker::send(Job job) {
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back({last_asked_.revision, std::move(job)});
  }
  change_.notify_all();
}

void FrameMaker::replace(Loader load) {
  {
    const std::lock_guard lock(mutex_);
    loader_ = std::move(load);
  }
  change_.notify_all();
}

void FrameMaker::work_on(std::function<void()> task) {
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  change_.notify_all();
}

void FrameMaker::post(Mail mail) {
  {
    const std::lock_guard lock(mutex_);
    mail_.push_back(std::move(mail));
  }
  news_();
}

std::vector<FrameMaker::Mail> FrameMaker::take_mail() {
  const std::lock_guard lock(mutex_);
  return std::exchange(mail_, {});
}

std::shared_ptr<const DrawnPicture> FrameMaker::newest() const {
  const std::lock_guard lock(mutex_);
  return drawn_;
}

std::string FrameMaker::hash_of(uint64_t revision) const {
  const std::lock_guard lock(mutex_);
  return revision == hashed_revision_ ? hash_ : std::string();
}

std::optional<std::string> FrameMaker::take_problem() {
  const std::lock_guard lock(mutex_);
  return std::exchange(problem_, std::nullopt);
}

bool FrameMaker::is_refused(uint64_t revision) const {
  const std::lock_guard lock(mutex_);
  return tried_revision_ == revision && !is_current_;
}

bool FrameMaker::busy() const {
  const std::lock_guard lock(mutex_);
  return at_work_ || asked_ || loader_ || !tasks_.empty() || !jobs_.empty() || !mail_.empty();
}

/// What a user gave us wrongly is a problem to tell of; the window goes on.
void FrameMaker::run(const std::function<void()>& task) {
  std::string problem;
  try {
    return task();
  } catch (const Error& error) {
    problem = error.what();
  } catch (const std::bad_alloc&) {
    problem = "memory: there is not enough (a smaller window or scene)";
  } catch (const std::exception& fault) {
    problem = std::string("internal: ") + fault.what() + " (please report it)";
  }
  {
    const std::lock_guard lock(mutex_);
    if (!problem_) problem_ = std::move(problem);  // the first is the cause of others
  }
  news_();
}

void FrameMaker::draw(ViewState state) {
  const uint64_t revision = state.revision;
  bool done = false;
  run([&] {
    auto picture = std::make_shared<DrawnPicture>();
    picture->pipeline = drawn_pipeline(state);
    scene_->show(state);
    picture->camera = scene_->scene().camera;
    if (scene_->scene().lights.size() <= DrawnPicture::kMostLights) picture->lights = scene_->scene().lights;
    const Clock::time_point start = Clock::now();
    picture->frame = render_frame(scene_->prepared(), picture->pipeline, execution_);
    picture->draw_ms = ms_since(start);
    const Clock::time_point drawn = Clock::now();
    DisplayTransform display = display_of(looks_of_text(state.looks), picture->pipeline, scene_->scene());
    display.divides_by_alpha = false;  // a window shows colours over black, as they are
    codes_.convert(picture->frame.color, values_of(picture->pipeline), display, picture->words);
    picture->convert_ms = ms_since(drawn);
    picture->state = std::move(state);
    const std::lock_guard lock(mutex_);
    drawn_ = std::move(picture);
    done = true;
  });
  {
    const std::lock_guard lock(mutex_);
    tried_revision_ = revision;
    is_current_ = done;
  }
  news_();
}

bool FrameMaker::ready_job() const { return !jobs_.empty() && tried_revision_ >= jobs_.front().revision; }

void FrameMaker::carry_out(const WaitingJob& next, const std::shared_ptr<const DrawnPicture>& picture) {
  run([&] {
    if (!picture)
      throw Error(ErrorKind::usage, "picture", "there is none of what is asked for", "go back to what can be drawn");
    next.job(*scene_, *picture);
  });
}

void FrameMaker::load_next() {
  const Loader load = [this] {
    const std::lock_guard lock(mutex_);
    return *std::exchange(loader_, std::nullopt);
  }();
  run([&] {
    scene_ = load();
    const std::lock_guard lock(mutex_);
    if (!asked_) asked_ = last_asked_;
    hashed_revision_ = tried_revision_ = 0;  // jobs wait for a picture of this scene
    is_current_ = false;
  });
}

void FrameMaker::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    const auto wanted = [this] { return ends_ || asked_ || loader_ || !tasks_.empty() || ready_job(); };
    const bool hash_is_missing = drawn_ && hashed_revision_ != drawn_->state.revision;
    at_work_ = false;
    if (!hash_is_missing)
      change_.wait(lock, wanted);
    else if (!change_.wait_for(lock, kStill, wanted)) {
      const std::shared_ptr<const DrawnPicture> picture = drawn_;
      lock.unlock();
      std::string hash = image_hash(picture->frame.color);
      lock.lock();
      hash_ = std::move(hash), hashed_revision_ = picture->state.revision;
      lock.unlock();
      news_();
      lock.lock();
      continue;
    }
    at_work_ = true;
    if (!tasks_.empty() && !ends_) {
      const std::function<void()> task = std::move(tasks_.front());
      tasks_.pop_front();
      lock.unlock();
      run(task);
      lock.lock();
    } else if (ready_job()) {
      const WaitingJob next = std::move(jobs_.front());
      const std::shared_ptr<const DrawnPicture> picture = is_current_ ? drawn_ : nullptr;
      jobs_.pop_front();
      lock.unlock();
      carry_out(next, picture);
      lock.lock();
    } else if (loader_ && !ends_) {
      lock.unlock();
      load_next();
      lock.lock();
    } else if (asked_) {
      ViewState state = *std::exchange(asked_, std::nullopt);
      lock.unlock();
      draw(std::move(state));
      lock.lock();
    } else if (ends_) {
      return;
    }
  }
}

}  // namespace trueshade::viewer
