#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "anatomy/patient.h"
#include "core/background_job.h"
#include "io/patient/patient_folder.h"
#include "ultrasound/tissue/acoustic_scene.h"

namespace trocar::cases {

/// Display data that a thread prepares after a case can be used: the acoustic scene and the surfaces. Surfaces come
/// first if they are in the patient folder or in the cache. Otherwise they are extracted after the scene, the skin
/// first, then from small structures to large ones, on one thread of low priority, because haptic servers and the
/// window run at the same time, and kept in the cache. Any thread may ask; only wait() and the destructor block, the
/// latter until the thread has stopped.
class LaterData {
 public:
  using Surfaces = std::shared_ptr<const std::vector<anatomy::NamedMesh>>;

  /// What the task needs first. kSurfaces: a task without ultrasound guidance; the acoustic scene then follows at low
  /// priority.
  enum class First : std::uint8_t { kUltrasound, kSurfaces };
  /// `source`: a patient folder, or an embedded patient with its cache folder (may be empty).
  LaterData(std::shared_ptr<const anatomy::VirtualPatient> patient, ultrasound::AcousticTable acoustics,
            io::PatientSource source, First first = First::kUltrasound);
  ~LaterData();
  LaterData(const LaterData&) = delete;
  LaterData& operator=(const LaterData&) = delete;

  /// nullptr until it is ready.
  std::shared_ptr<const ultrasound::AcousticScene> acoustic() const;
  /// Groups of surfaces that were ready after the first `known` ones.
  std::vector<Surfaces> surfaces_after(std::size_t known) const;
  /// The present step, "3D surfaces: 12 of 57", and the progress of all.
  JobView view() const;
  /// What could not be prepared, one line each.
  std::vector<std::string> errors() const;
  /// Stops within half a second; the rest never becomes ready.
  void cancel() noexcept;
  /// Waits until everything is ready.
  void wait() const;

 private:
  void work(const std::stop_token& stop);
  void make_acoustics();
  double share_of_whole(bool is_acoustic, double fraction) const noexcept;
  /// From the patient folder or the cache; false: they must be extracted.
  bool read_surfaces();
  void extract_surfaces(const std::stop_token& stop);
  void add(std::vector<anatomy::NamedMesh> meshes);
  void show(std::string step, double fraction);
  void note(const Error& error);

  std::shared_ptr<const anatomy::VirtualPatient> patient_;
  ultrasound::AcousticTable acoustics_;
  io::PatientSource source_;
  First first_;

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::shared_ptr<const ultrasound::AcousticScene> acoustic_;
  std::vector<Surfaces> surfaces_;
  std::vector<std::string> errors_;
  JobView view_;
  std::jthread thread_;  ///< The last member: it uses the others.
};

}  // namespace trocar::cases
