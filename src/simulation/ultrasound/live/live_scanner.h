#pragma once

#include <memory>

#include "core/live/feed.h"
#include "ultrasound/live/scan_picture.h"

namespace trocar::ultrasound {

/// Limits of a live scanner's processor time, which leave time for real-time threads.
struct LiveScannerOptions {
  int threads = 1;  ///< Threads per frame. Range 1..64.
  int nice = 5;     ///< Added to the worker's niceness where the system has one. Range 0..19.
  ScanPace pace;
};
/// One thread on small machines; more on machines where two servers, the window and the drawing still have a core each.
LiveScannerOptions default_live_scanner_options();

/// State of the cine loop at the newest picture.
struct CineState {
  bool is_frozen = false;
  bool is_playing = false;
  int position = -1;  ///< Displayed frame; frames count from the oldest, 0.
  int size = 0;
};

/// A live scanner: a thread renders the newest request (older ones are dropped) at the detail that the time budget
/// permits, and stores frames in a cine loop. It renders only if a request has changed or a refresh is due
/// (ScanSchedule). One thread, e.g. that of the window, makes all calls; only the destructor waits for a frame.
class LiveScanner {
 public:
  explicit LiveScanner(const LiveScannerOptions& options = default_live_scanner_options());
  ~LiveScanner();
  LiveScanner(const LiveScanner&) = delete;
  LiveScanner& operator=(const LiveScanner&) = delete;

  /// Sets another patient or transducer: removes pictures, requests and the cine loop, and unfreezes the scanner.
  void open(std::shared_ptr<const AcousticScene> scene, Transducer transducer);

  /// A request with a non-finite pose or needle is ignored. Settings are clamped.
  void request(ScanRequest request);
  /// The pictures, for any thread; none before the first one.
  const Feed<ScanPicture>& pictures() const noexcept;

  /// While frozen, requests change only gain, dynamic range, gray map, mirroring and size of the picture. Depth,
  /// frequency and TGC take effect after the freeze. Has no effect before the first picture.
  void set_frozen(bool is_frozen);
  /// Functions of the frozen loop. step_cine and show_cine stop a playing loop.
  void step_cine(int frames);
  void show_cine(int index);
  void play_cine(bool is_playing);
  CineState cine() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::ultrasound
