#include "run/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "io/frame_directory.h"
#include "io/video_file.h"

namespace aspic {
namespace {

/// What waits for the encoder at most: enough for its moods, little beside a simulation.
constexpr std::size_t most_waiting_bytes = std::size_t{128} << 20;

Result<std::unique_ptr<FrameSink>> open_sink(const FilmOptions& options) {
  if (is_directory(options.format)) {
    const ImageFormat format = options.format == FilmFormat::png ? ImageFormat::png : ImageFormat::jpg;
    return open_frame_directory(options.path, format, options.size, Overwrite::refuse);
  }
  return open_video(options.path, options.size, options.fps, Overwrite::refuse);
}

}  // namespace

std::string_view name_of(FilmFormat format) {
  switch (format) {
    case FilmFormat::mp4:
      return "mp4";
    case FilmFormat::webm:
      return "webm";
    case FilmFormat::gif:
      return "gif";
    case FilmFormat::png:
      return "png";
    case FilmFormat::jpeg:
      return "jpeg";
  }
  return "";
}

std::optional<FilmFormat> film_format_of(std::string_view name) {
  const auto found =
      std::ranges::find_if(film_formats, [&](FilmFormat format) { return name_of(format) == name; });
  return found == std::end(film_formats) ? std::nullopt : std::optional(*found);
}

bool is_directory(FilmFormat format) {
  return format == FilmFormat::png || format == FilmFormat::jpeg;
}

double most_fps(FilmFormat format) {
  return format == FilmFormat::gif ? default_fps(VideoFormat::gif) : 240.0;
}

std::string film_path(const std::string& path, FilmFormat format) {
  std::filesystem::path named(path);
  const std::string end = named.extension().string();
  const bool film_end = end.size() > 1 && film_format_of(end.substr(1)).has_value();
  if (film_end) named.replace_extension();
  std::string text = named.string();
  if (!is_directory(format)) text += fmt::format(".{}", name_of(format));
  return text;
}

std::string free_film_name(const std::string& scene, FilmFormat format) {
  const std::string stem = std::filesystem::path(scene).stem().string();
  for (int number = 1;; ++number) {
    const std::string name = film_path(fmt::format("aspic-{}-{:04}", stem, number), format);
    std::error_code error;
    if (!std::filesystem::exists(std::filesystem::symlink_status(name, error))) return name;
  }
}

Result<std::unique_ptr<Recording>> Recording::start(gl::Context& context, FilmOptions options) {
  if (options.fps > most_fps(options.format)) {
    return Error{ErrorCode::usage,
                 fmt::format("A film as {} shows at most {} pictures a second, not {}.",
                             name_of(options.format), most_fps(options.format), options.fps)};
  }
  if (options.format == FilmFormat::mp4 || options.format == FilmFormat::webm) {
    options.size.width = std::max(options.size.width & ~1, 16);
    options.size.height = std::max(options.size.height & ~1, 16);
  }
  std::error_code unknown;
  if (is_directory(options.format) && std::filesystem::exists(options.path, unknown) &&
      !std::filesystem::is_empty(options.path, unknown)) {
    return Error{ErrorCode::io,
                 fmt::format("{} exists already and is not an empty directory. Choose another name for "
                             "the pictures.",
                             options.path)};
  }
  auto ring = gl::PixelRing::create(context, options.size.width, options.size.height);
  if (!ring) return ring.error();
  auto sink = open_sink(options);
  if (!sink) return sink.error();
  return std::unique_ptr<Recording>(new Recording(std::move(*ring), std::move(*sink), std::move(options)));
}

Recording::Recording(gl::PixelRing ring, std::unique_ptr<FrameSink> sink, FilmOptions options)
    : options_(std::move(options)), ring_(std::move(ring)), sink_(std::move(sink)) {
  const std::size_t bytes =
      3 * static_cast<std::size_t>(options_.size.width) * static_cast<std::size_t>(options_.size.height);
  most_waiting_ = std::clamp<std::size_t>(most_waiting_bytes / bytes, 2, 64);
  thread_ = std::thread([this] { encode(); });
}

Recording::~Recording() {
  {
    const std::lock_guard lock(mutex_);
    abandoned_ = !ended_;
    no_more_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

bool Recording::ready() const {
  const std::lock_guard lock(mutex_);
  return waiting_.size() < most_waiting_ || completed_;
}

Status Recording::hand_on() {
  Picture picture;
  picture.copies = copies_.front();
  copies_.pop_front();
  if (const Status taken = ring_.take(picture.pixels); !taken) return taken;
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(picture));
  }
  changed_.notify_all();
  return {};
}

Status Recording::add(const gl::Framebuffer& picture, std::uint64_t copies) {
  if (ring_.full()) {
    if (const Status handed = hand_on(); !handed) return handed;
  }
  ring_.submit(picture);
  copies_.push_back(copies);
  pictures_ += copies;
  return {};
}

Status Recording::progress() {
  return ring_.pending() > 0 ? hand_on() : Status();
}

void Recording::end() {
  if (ended_) return;
  ended_ = true;
  while (ring_.pending() > 0 && hand_on()) {
  }
  {
    const std::lock_guard lock(mutex_);
    no_more_ = true;
  }
  changed_.notify_all();
}

bool Recording::completed() const {
  const std::lock_guard lock(mutex_);
  return completed_;
}

Status Recording::result() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return completed_; });
  return result_;
}

void Recording::encode() {
  Status result;
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return !waiting_.empty() || no_more_; });
    if (abandoned_ || waiting_.empty()) break;
    const Picture picture = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    for (std::uint64_t i = 0; i < picture.copies && result; ++i) result = sink_->write(picture.pixels);
    lock.lock();
    if (!result) break;
  }
  const bool complete = result && !abandoned_;
  lock.unlock();
  if (complete) result = sink_->finish();
  sink_.reset();
  lock.lock();
  waiting_.clear();
  result_ = result;
  completed_ = true;
  lock.unlock();
  changed_.notify_all();
}

}  // namespace aspic
