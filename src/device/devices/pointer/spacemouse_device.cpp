#include "devices/pointer/spacemouse_device.h"

#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <spnav.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <string>

#include "devices/detail/factories.h"
#include "realtime/periodic_loop.h"

#undef Status  // <spnav.h> includes Xlib's macros

namespace trocar::devices {
namespace {

constexpr int kMostEvents = 64;                                // events per poll
constexpr int kMostButtons = 16;                               // stored as bits
constexpr std::size_t kEventBytes = 8 * sizeof(std::int32_t);  // spacenavd's protocol: eight integers per event

double cap_response(int counts) noexcept {
  const double size = std::abs(static_cast<double>(counts));
  const double beyond = std::clamp((size - kCapDeadZone_counts) / (kCapFull_counts - kCapDeadZone_counts), 0.0, 1.0);
  return std::copysign(std::pow(beyond, kCapExponent), counts);
}

enum class Socket { kQuiet, kHasEvent, kClosed };

/// libspnav treats half an event as a whole one and a closed connection as no event: check before it reads. spacenavd
/// sends whole events; half an event means the end.
Socket look(int descriptor) noexcept {
  std::array<char, kEventBytes> bytes;
  const ssize_t count = ::recv(descriptor, bytes.data(), bytes.size(), MSG_PEEK | MSG_DONTWAIT);
  if (count == static_cast<ssize_t>(kEventBytes)) return Socket::kHasEvent;
  return count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) ? Socket::kQuiet : Socket::kClosed;
}

class SpaceMouseSource final : public PointerSource {
 public:
  ~SpaceMouseSource() override { close(); }

  std::string name() const override { return "spacemouse"; }
  Status open() override;
  bool poll(PointerMotion& motion) noexcept override;
  void close() noexcept override;

 private:
  void take(const spnav_event& event) noexcept;

  bool is_open_ = false;
  SpaceMouseAxes axes_;
  std::int64_t moved_ns_ = 0;
  std::uint32_t buttons_ = 0;
};

Status SpaceMouseSource::open() {
  // libspnav writes to a socket that may already be closed.
  sigset_t pipe;
  sigemptyset(&pipe);
  sigaddset(&pipe, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &pipe, nullptr);
  axes_ = {};
  buttons_ = 0;
  errno = 0;
  if (spnav_open() != 0) {
    return fail(
        "spacenavd does not respond", "spacemouse",
        "install the package spacenavd, plug the SpaceMouse in, start it (systemctl start spacenavd), and close "
        "another spacemouse of this program");
  }
  is_open_ = true;
  return {};
}

bool SpaceMouseSource::poll(PointerMotion& motion) noexcept {
  for (int i = 0; i < kMostEvents; ++i) {
    const Socket socket = look(spnav_fd());
    if (socket == Socket::kClosed) return false;
    if (socket == Socket::kQuiet) break;
    spnav_event event{};
    if (spnav_poll_event(&event) != 0) take(event);
    if (event.type == SPNAV_EVENT_DEV && event.dev.op == SPNAV_DEV_RM) return false;
  }
  if (realtime::now_ns() - moved_ns_ > kCapSilence_ns) axes_ = {};
  motion = spacemouse_motion(axes_, buttons_);
  return true;
}

void SpaceMouseSource::take(const spnav_event& event) noexcept {
  if (event.type == SPNAV_EVENT_MOTION) {
    const spnav_event_motion& cap = event.motion;
    axes_.counts = {cap.x, cap.y, cap.z, cap.rx, cap.ry, cap.rz};
    moved_ns_ = realtime::now_ns();
  } else if (event.type == SPNAV_EVENT_BUTTON && event.button.bnum >= 0 && event.button.bnum < kMostButtons) {
    const std::uint32_t bit = 1U << static_cast<unsigned>(event.button.bnum);
    buttons_ = event.button.press != 0 ? buttons_ | bit : buttons_ & ~bit;
  }
}

void SpaceMouseSource::close() noexcept {
  if (is_open_) spnav_close();
  is_open_ = false;
}

}  // namespace

PointerMotion spacemouse_motion(const SpaceMouseAxes& axes, std::uint32_t buttons) noexcept {
  const auto& [x, y, z, rx, ry, rz] = axes.counts;
  PointerMotion motion;
  // D is x right, y away, z up: y and z are exchanged, which also inverts the sense of rotations.
  motion.v_D = kCapSpeed_mm_per_s * Vec3(cap_response(x), cap_response(z), cap_response(y));
  motion.w_D = kCapTurning_rad_per_s * Vec3(cap_response(rx), cap_response(rz), cap_response(ry));
  motion.buttons = buttons;
  return motion;
}

std::unique_ptr<PointerSource> make_spacemouse_source() {
  return std::make_unique<SpaceMouseSource>();
}

OpenedDevice open_spacemouse(const DeviceSpec&, const DeviceOptions& options) {
  TROCAR_TRY(const stylus::DevicePreset preset, load_preset_of(options, "spacemouse"));
  return PolledPointer::open(preset, make_spacemouse_source());
}

}  // namespace trocar::devices
