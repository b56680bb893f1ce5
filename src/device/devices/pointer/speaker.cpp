#include "devices/pointer/speaker.h"

#include <SDL.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>
#include <thread>

#include "core/files/folders.h"
#include "core/log.h"
#include "core/random.h"
#include "core/start_thread.h"

namespace trocar::devices {
namespace {

/// Checks for an audio output: libraries that find none write to standard error.
bool has_output() {
  namespace fs = std::filesystem;
  if (std::getenv("SDL_AUDIODRIVER") != nullptr || std::getenv("PULSE_SERVER") != nullptr) return true;
  if (const auto devices = list_folder("/dev/snd"))
    for (const fs::path& device : *devices)
      if (device.filename().string().starts_with("pcm")) return true;
  std::error_code error;
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  return runtime != nullptr && fs::exists(fs::path(runtime) / "pulse" / "native", error);
}

SDL_AudioDeviceID open_output() {
  if (!has_output() || SDL_InitSubSystem(SDL_INIT_AUDIO) != 0) return 0;
  SDL_AudioSpec wanted{};
  wanted.freq = Speaker::kRate_hz;
  wanted.format = AUDIO_F32SYS;
  wanted.channels = 1;
  wanted.samples = 512;
  const SDL_AudioDeviceID device = SDL_OpenAudioDevice(nullptr, 0, &wanted, nullptr, 0);
  if (device != 0) SDL_PauseAudioDevice(device, 0);
  return device;
}

/// Two decaying tones and noise, as from a light metal part that hits a stop.
double click_at(double time_s, double noise) {
  constexpr double kTwoPi = 2.0 * std::numbers::pi;
  constexpr double kRing_hz = 2300.0, kHiss_s = 0.004, kRing_s = 0.008, kBody_hz = 190.0, kBody_s = 0.03;
  if (time_s < 0.0) return 0.0;
  return 0.5 * noise * std::exp(-time_s / kHiss_s) +
         0.3 * std::sin(kTwoPi * kRing_hz * time_s) * std::exp(-time_s / kRing_s) +
         0.2 * std::sin(kTwoPi * kBody_hz * time_s) * std::exp(-time_s / kBody_s);
}

}  // namespace

struct Speaker::Impl {
  std::atomic<SDL_AudioDeviceID> device{0};
  std::atomic<bool> is_opening{true};
  std::thread opening;
};

Speaker::Speaker() : impl_(std::make_unique<Impl>()) {
  auto thread = start_thread("sound", [impl = impl_.get()] {
    impl->device = open_output();
    impl->is_opening = false;
  });
  if (thread) {
    impl_->opening = *std::move(thread);
  } else {
    log_warning("no sound: {}", thread.error().text());
    impl_->is_opening = false;
  }
}

Speaker::~Speaker() {
  if (impl_->opening.joinable()) impl_->opening.join();
  if (const SDL_AudioDeviceID device = impl_->device) SDL_CloseAudioDevice(device);
}

void Speaker::play(std::span<const float> samples) {
  const SDL_AudioDeviceID device = impl_->device;
  if (device == 0) return;
  SDL_ClearQueuedAudio(device);
  SDL_QueueAudio(device, samples.data(), static_cast<Uint32>(samples.size_bytes()));
}

bool Speaker::is_open() const noexcept {
  return impl_->device != 0;
}

bool Speaker::is_opening() const noexcept {
  return impl_->is_opening;
}

std::vector<float> make_gun_click() {
  constexpr double kCannulaAfter_s = 0.06, kWhole_s = 0.25, kCannula = 0.7, kVolume = 0.6;
  Random random(1);
  std::vector<float> samples(static_cast<std::size_t>(kWhole_s * Speaker::kRate_hz));
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const double time_s = static_cast<double>(n) / Speaker::kRate_hz;
    const double noise = 2.0 * random.uniform() - 1.0;
    const double sound = click_at(time_s, noise) + kCannula * click_at(time_s - kCannulaAfter_s, noise);
    samples[n] = static_cast<float>(std::clamp(kVolume * sound, -1.0, 1.0));
  }
  return samples;
}

}  // namespace trocar::devices
