#include "cases/later_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <string>
#include <utility>

#include "core/live/live_schedule.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/start_thread.h"
#include "io/patient/patient_cache.h"
#include "surface/extract_surface.h"

namespace trocar::cases {
namespace {

constexpr double kAcousticShare = 0.3;  ///< Of the whole work.
constexpr int kNice = 5;                ///< As the thread of the live ultrasound.

/// Skin first, then in the order of the label table.
void sort_by_label(std::vector<anatomy::NamedMesh>& meshes, const anatomy::LabelTable& table) {
  const auto id_of = [&](const anatomy::NamedMesh& mesh) {
    const anatomy::Label* label = table.find(mesh.name);
    return label != nullptr ? label->id : std::uint8_t{0};
  };
  std::stable_sort(meshes.begin(), meshes.end(), [&](const auto& a, const auto& b) { return id_of(a) < id_of(b); });
}

}  // namespace

LaterData::LaterData(std::shared_ptr<const anatomy::VirtualPatient> patient, ultrasound::AcousticTable acoustics,
                     io::PatientSource source, First first)
    : patient_(std::move(patient)), acoustics_(std::move(acoustics)), source_(std::move(source)), first_(first) {
  show(first == First::kUltrasound ? "ultrasound" : "3D surfaces", 0.0);
  auto thread = start_stoppable_thread("picture data", [this](const std::stop_token& stop) { work(stop); });
  if (thread) {
    thread_ = *std::move(thread);
  } else {
    note(thread.error());
    view_ = {"ready", 1.0, true};
  }
}

LaterData::~LaterData() = default;

std::shared_ptr<const ultrasound::AcousticScene> LaterData::acoustic() const {
  const std::lock_guard lock(mutex_);
  return acoustic_;
}

std::vector<LaterData::Surfaces> LaterData::surfaces_after(std::size_t known) const {
  const std::lock_guard lock(mutex_);
  if (known >= surfaces_.size()) return {};
  return {surfaces_.begin() + static_cast<std::ptrdiff_t>(known), surfaces_.end()};
}

JobView LaterData::view() const {
  const std::lock_guard lock(mutex_);
  return view_;
}

std::vector<std::string> LaterData::errors() const {
  const std::lock_guard lock(mutex_);
  return errors_;
}

void LaterData::cancel() noexcept {
  thread_.request_stop();
}

void LaterData::wait() const {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return view_.is_done; });
}

void LaterData::work(const std::stop_token& stop) {
  const CancellationScope scope(stop);
  try {
    const bool has_surfaces = read_surfaces();
    cancellation_point();
    if (first_ == First::kUltrasound) {
      make_acoustics();
      if (!has_surfaces) extract_surfaces(stop);
    } else {
      if (!has_surfaces) extract_surfaces(stop);
      lower_priority(kNice);
      run_on_threads(1, [this] { make_acoustics(); });
    }
  } catch (const Cancelled&) {
    // The rest never becomes ready.
  } catch (const std::bad_alloc&) {
    note({"not enough memory for the pictures of the case", patient_->name, "close other programs"});
  } catch (const std::exception& error) {  // of a library: this thread has no caller
    note({std::string("no pictures of the case: ").append(error.what()), patient_->name, "open the case again"});
  }
  const std::lock_guard lock(mutex_);
  view_ = {"ready", 1.0, true};
  changed_.notify_all();
}

double LaterData::share_of_whole(bool is_acoustic, double fraction) const noexcept {
  if (first_ == First::kUltrasound)
    return is_acoustic ? kAcousticShare * fraction : std::lerp(kAcousticShare, 1.0, fraction);
  return is_acoustic ? std::lerp(1.0 - kAcousticShare, 1.0, fraction) : (1.0 - kAcousticShare) * fraction;
}

void LaterData::make_acoustics() {
  const Progress progress = [this](std::string_view, double fraction) {
    show("ultrasound", share_of_whole(true, fraction));
  };
  auto scene = ultrasound::make_acoustic_scene(*patient_, std::move(acoustics_), {}, progress);
  if (!scene) return note(scene.error());
  const std::lock_guard lock(mutex_);
  acoustic_ = *std::move(scene);
}

bool LaterData::read_surfaces() {
  show("3D surfaces", 0.0);
  if (io::is_path(source_.folder_or_name)) {
    auto meshes = io::open_meshes(source_, *patient_);
    meshes ? add(*std::move(meshes)) : note(meshes.error());
    return true;
  }
  auto kept = io::find_kept_meshes(source_);
  if (kept) add(*std::move(kept));
  return kept.has_value();
}

void LaterData::extract_surfaces(const std::stop_token& stop) {
  show("3D surfaces", share_of_whole(false, 0.0));
  lower_priority(kNice);
  std::vector<anatomy::NamedMesh> all;
  const auto receive = [&](anatomy::NamedMesh mesh, std::size_t done, std::size_t count) {
    const double share = static_cast<double>(done) / static_cast<double>(count);
    show(fmt::format("3D surfaces: {} of {}", done, count), share_of_whole(false, share));
    if (!mesh.mesh_P.triangles.empty()) {
      all.push_back(mesh);
      add({std::move(mesh)});
    }
    return !stop.stop_requested();
  };
  run_on_threads(1, [&] { surface::extract_each_surface(*patient_, {}, receive); });
  if (stop.stop_requested() || source_.cache_folder.empty()) return;
  sort_by_label(all, patient_->label_table);
  const Status kept = io::PatientCache(source_.cache_folder).keep_surfaces(source_, all);
  if (!kept) log_info("the surfaces are not cached: {}", kept.error().text());
}

void LaterData::add(std::vector<anatomy::NamedMesh> meshes) {
  auto group = std::make_shared<const std::vector<anatomy::NamedMesh>>(std::move(meshes));
  const std::lock_guard lock(mutex_);
  surfaces_.push_back(std::move(group));
}

void LaterData::show(std::string step, double fraction) {
  cancellation_point();
  const std::lock_guard lock(mutex_);
  view_ = {std::move(step), fraction, false};
}

void LaterData::note(const Error& error) {
  const std::lock_guard lock(mutex_);
  errors_.push_back(error.text());
}

}  // namespace trocar::cases
