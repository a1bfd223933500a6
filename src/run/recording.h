#pragma once
// Pictures on their way to the disk: read back from the device, encoded by a thread of its own.
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "aspic/run.h"
#include "base/result.h"
#include "gpu/pixel_ring.h"
#include "io/film_format.h"

namespace aspic {

/// What the pictures of a film have in common.
struct FilmOptions {
  std::string path;   ///< of the first sink
  double fps = 60.0;  ///< pictures shown per second, > 0
  PictureSize size;
};

/// Takes pictures of one size. Nothing is dropped: while the encoder is behind, ready() is false. A sink that
/// fails is lost alone; the others continue. One that is destroyed before its end() leaves no film file, only
/// the pictures of a directory. Every call enters the context (gpu/current.h).
class Recording {
 public:
  /// All sinks get every picture. Error (scene_rejected): no device memory. The context must outlive end().
  static Result<std::unique_ptr<Recording>> start(gl::Context& context,
                                                  std::vector<std::unique_ptr<FrameSink>> sinks,
                                                  FilmOptions options);
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  const FilmOptions& options() const { return options_; }
  /// Pictures taken so far, and how long the film is with them [s].
  std::uint64_t pictures() const { return pictures_; }
  double seconds() const { return static_cast<double>(pictures_) / options_.fps; }

  /// Whether a picture can be added without waiting for the encoder.
  bool ready() const;
  /// Waits until it can.
  void wait_until_ready();
  /// Adds a picture of the options' size, `copies` ≥ 1 times; legal until end(). Error (no_device): the
  /// device was lost.
  Status add(const gl::Framebuffer& picture, std::uint64_t copies);

  /// Hands the oldest picture on the device to the encoder, if there is one: once for each of the window's
  /// pictures that is none of the film's. Error as add().
  Status progress();
  /// No more pictures: the film is completed by the thread. Pictures that a lost device still held are
  /// missing.
  void end();
  /// The same, but every picture must come from the device. Error (no_device): one did not; then no film file
  /// is left, only the pictures of a directory.
  Status end_complete();
  /// Ends without a film file.
  void abandon();
  /// The thread is through, be it with the film or with an error.
  bool completed() const;
  /// Waits for that. Error (io): the first of failures(). A film file that fails leaves nothing behind.
  Status result();
  /// Of the sinks that could not be written so far. When all are lost, the recording is completed.
  std::vector<Error> failures() const;
  /// Waits too; the paths of the sinks that were completed.
  std::vector<std::string> written();
  /// Seconds spent on reading back and, by the thread, on encoding.
  FrameTimes times() const;

 private:
  Recording(gl::Context& context, gl::PixelRing ring, std::vector<std::unique_ptr<FrameSink>> sinks,
            FilmOptions options);
  struct Picture {
    std::vector<std::byte> pixels;
    std::uint64_t copies = 1;
  };
  Status hand_on();
  void encode();
  void write(const Picture& picture);
  template <class Work>
  bool carry_out(std::unique_ptr<FrameSink>& sink, const Work& work);

  gl::Context& context_;
  FilmOptions options_;
  gl::PixelRing ring_;
  std::deque<std::uint64_t> copies_;  // of the ring's pictures
  std::uint64_t pictures_ = 0;
  double read_seconds_ = 0.0;
  std::size_t most_waiting_;
  bool ended_ = false;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Picture> waiting_;  // guarded, as all below
  bool no_more_ = false, abandoned_ = false, completed_ = false;
  std::vector<Error> failures_;
  std::vector<std::string> written_;
  double encode_seconds_ = 0.0;
  std::vector<std::unique_ptr<FrameSink>> sinks_;  // the thread's own; null: lost
  std::thread thread_;
};

}  // namespace aspic
