#pragma once
// Writes frames: reads them back from the device and encodes them on a thread of its own.
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
#include "io/video_format.h"

namespace aspic {

/// Path, rate and size of a video.
struct VideoOptions {
  std::string path;   ///< of the first sink
  double fps = 60.0;  ///< frames shown per second, > 0
  ImageSize size;
};

/// Takes frames of one size and drops none: while the encoder is behind, ready() is false. If a sink fails,
/// the others continue. A recording destroyed before end() leaves no video file, only the frames of a
/// directory. Every call enters the context (gpu/current.h).
class Recording {
 public:
  /// All sinks get every frame. Error (scene_rejected): no device memory. The context must outlive end().
  static Result<std::unique_ptr<Recording>> start(gl::Context& context,
                                                  std::vector<std::unique_ptr<FrameSink>> sinks,
                                                  VideoOptions options);
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  const VideoOptions& options() const { return options_; }
  /// Frames taken so far, and the length of the video with them [s].
  std::uint64_t frames() const { return frames_; }
  double seconds() const { return static_cast<double>(frames_) / options_.fps; }

  /// Whether a frame can be added without waiting for the encoder.
  bool ready() const;
  /// Waits until it can.
  void wait_until_ready();
  /// Adds a frame of the options' size, `copies` ≥ 1 times; legal until end(). Error (no_device): the
  /// device was lost.
  Status add(const gl::Framebuffer& frame, std::uint64_t copies);

  /// Hands the oldest frame on the device to the encoder, if there is one. Call it for each frame of the
  /// window that the video does not take. Error as add().
  Status progress();
  /// Ends the video, which the thread completes. Frames that a lost device still held are missing.
  void end();
  /// The same, but every frame must come from the device. Error (no_device): one did not; then no video file
  /// is left, only the frames of a directory.
  Status end_complete();
  /// Ends without a video file.
  void abandon();
  /// Whether the thread has ended, with the video or with an error.
  bool completed() const;
  /// Waits for that. Error (io): the first of failures(). A video file that fails leaves nothing behind.
  Status result();
  /// Of the sinks that could not be written so far. When all are lost, the recording is completed.
  std::vector<Error> failures() const;
  /// Waits too; the paths of the sinks that were completed.
  std::vector<std::string> written();
  /// Seconds spent on reading back and, by the thread, on encoding.
  FrameTimes times() const;

 private:
  Recording(gl::Context& context, gl::PixelRing ring, std::vector<std::unique_ptr<FrameSink>> sinks,
            VideoOptions options);
  struct Frame {
    std::vector<std::byte> pixels;
    std::uint64_t copies = 1;
  };
  Status hand_on();
  void encode();
  void write(const Frame& frame);
  template <class Work>
  bool carry_out(std::unique_ptr<FrameSink>& sink, const Work& work);

  gl::Context& context_;
  VideoOptions options_;
  gl::PixelRing ring_;
  std::deque<std::uint64_t> copies_;  // of the ring's frames
  std::uint64_t frames_ = 0;
  double read_seconds_ = 0.0;
  std::size_t most_waiting_;
  bool ended_ = false;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Frame> waiting_;  // guarded, as all below
  bool no_more_ = false, abandoned_ = false, completed_ = false;
  std::vector<Error> failures_;
  std::vector<std::string> written_;
  double encode_seconds_ = 0.0;
  std::vector<std::unique_ptr<FrameSink>> sinks_;  // the thread's own; null: lost
  std::thread thread_;
};

}  // namespace aspic
