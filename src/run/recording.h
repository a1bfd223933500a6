#pragma once
// A film on its way to the disk: read back from the device, encoded by a thread of its own.
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/result.h"
#include "gpu/pixel_ring.h"
#include "io/frame_sink.h"

namespace aspic {

/// What a film is written as: one file, or a directory of numbered pictures.
enum class FilmFormat { mp4, webm, gif, png, jpeg };
inline constexpr FilmFormat film_formats[] = {FilmFormat::mp4, FilmFormat::webm, FilmFormat::gif,
                                              FilmFormat::png, FilmFormat::jpeg};

/// As people and state files call it: "mp4".
std::string_view name_of(FilmFormat format);
std::optional<FilmFormat> film_format_of(std::string_view name);
/// Whether the pictures go into a directory.
bool is_directory(FilmFormat format);
/// The most pictures per second that viewers of the format show.
double most_fps(FilmFormat format);
/// `path` with the end that the format wants, another format's end replaced; directories have none.
std::string film_path(const std::string& path, FilmFormat format);
/// A name in the working directory that nobody has taken yet: `aspic-cube-plane-0001.mp4`. `scene` is a file
/// or a built-in name.
std::string free_film_name(const std::string& scene, FilmFormat format);

/// What the next film will be.
struct FilmSettings {
  FilmFormat format = FilmFormat::mp4;
  double fps = 60.0;  ///< pictures shown per second, 1 … most_fps
  bool text = true;   ///< the parameters stand in the picture
  std::string path;   ///< empty: free_film_name()
};

struct FilmOptions {
  std::string path;
  FilmFormat format = FilmFormat::mp4;
  double fps = 60.0;  ///< pictures shown per second, > 0
  PictureSize size;   ///< made even where the format wants that
};

/// Takes pictures of one size. Nothing is dropped: while the encoder is behind, ready() is false. One that is
/// destroyed before its end() leaves no film file, only the pictures of a directory.
class Recording {
 public:
  /// Errors: usage (more pictures a second than the format has), io (the name is taken, its place cannot be
  /// written, ffmpeg is missing), scene_rejected (no device memory). The context must outlive end().
  static Result<std::unique_ptr<Recording>> start(gl::Context& context, FilmOptions options);
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  const FilmOptions& options() const { return options_; }
  /// Pictures taken so far, and how long the film is with them [s].
  std::uint64_t pictures() const { return pictures_; }
  double seconds() const { return static_cast<double>(pictures_) / options_.fps; }

  /// Whether a picture can be added without waiting for the encoder.
  bool ready() const;
  /// Adds a picture of the options' size, `copies` ≥ 1 times; legal until end(). Error (no_device): the
  /// device was lost.
  Status add(const gl::Framebuffer& picture, std::uint64_t copies);
  /// Hands the oldest picture on the device to the encoder, if there is one: once for each of the window's
  /// pictures that is none of the film's. Error as add().
  Status progress();
  /// No more pictures: the film is completed by the thread. Pictures that a lost device still held are
  /// missing.
  void end();
  /// The thread is through, be it with the film or with an error.
  bool completed() const;
  /// Waits for that. Error (io): the film could not be written; a film file leaves nothing behind then.
  Status result();

 private:
  Recording(gl::PixelRing ring, std::unique_ptr<FrameSink> sink, FilmOptions options);
  struct Picture {
    std::vector<std::byte> pixels;
    std::uint64_t copies = 1;
  };
  Status hand_on();
  void encode();

  FilmOptions options_;
  gl::PixelRing ring_;
  std::deque<std::uint64_t> copies_;  // of the ring's pictures
  std::uint64_t pictures_ = 0;
  std::size_t most_waiting_;
  bool ended_ = false;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Picture> waiting_;  // guarded, as all below
  bool no_more_ = false, abandoned_ = false, completed_ = false;
  Status result_;
  std::unique_ptr<FrameSink> sink_;  // the thread's own
  std::thread thread_;
};

}  // namespace aspic
