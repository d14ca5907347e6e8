#include "proofmass/acquire/serial/port.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>
#include <utility>

namespace proofmass::acquire {
namespace {

/// A descriptor that is closed by the destructor.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

/// Error counts of the driver: bytes dropped by overruns, and invalid characters.
struct LineTrouble {
  int overrun = 0, buffer_overrun = 0, framing = 0, parity = 0;
};

class SerialFeed final : public BytePump {
 public:
  SerialFeed(Descriptor descriptor, std::string device)
      : descriptor_(std::move(descriptor)), device_(std::move(device)) {
    has_counts_ = count(before_);
  }

  Result<Fed> read(std::span<char> into, std::chrono::milliseconds patience) override {
    if (!wait_readable(descriptor_.number(), patience)) return Fed{};
    const ssize_t bytes = ::read(descriptor_.number(), into.data(), into.size());
    if (bytes > 0) return Fed{static_cast<std::size_t>(bytes)};
    if (bytes < 0 && (errno == EAGAIN || errno == EINTR)) return Fed{};
    // A line without a modem never ends: readable without data means that the device is gone.
    return Error{
        Errc::device,
        fmt::format("{} was unplugged{}", device_,
                    bytes < 0 && errno != EIO ? fmt::format(" ({})", std::strerror(errno)) : "")};
  }

  std::vector<Note> take_notes() override {
    LineTrouble now;
    std::vector<Note> notes;
    if (!has_counts_ || !count(now)) return notes;
    const int dropped = now.overrun - before_.overrun + now.buffer_overrun - before_.buffer_overrun;
    if (dropped > 0)
      notes.push_back({Severity::bad,
                       fmt::format("the driver dropped bytes {} times, as they were not fetched in "
                                   "time: rows are missing or damaged here",
                                   dropped)});
    const int broken = now.framing - before_.framing + now.parity - before_.parity;
    if (broken > 0)
      notes.push_back({Severity::warning,
                       fmt::format("{} characters were damaged on the line: is the baud rate "
                                   "another?",
                                   broken)});
    before_ = now;
    return notes;
  }

 private:
  /// False if the driver does not count. Source: ioctl_tty(2), TIOCGICOUNT.
  [[nodiscard]] bool count(LineTrouble& out) const {
    serial_icounter_struct counts{};
    if (::ioctl(descriptor_.number(), TIOCGICOUNT, &counts) != 0) return false;
    out = {counts.overrun, counts.buf_overrun, counts.frame, counts.parity};
    return true;
  }

  Descriptor descriptor_;
  std::string device_;
  bool has_counts_ = false;
  LineTrouble before_;
};

Error refusal(const std::string& device, int problem) {
  const auto because = [&](const std::string& why) {
    return Error{Errc::device, fmt::format("{}: {}", device, why)};
  };
  switch (problem) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return Error{Errc::device,
                   fmt::format("{}: there is no such device: is it plugged in?", device),
                   {Advice{"list"}}};
    case EACCES:
    case EPERM:
      return because(
          "no permission: add yourself to the group of the device (mostly: sudo usermod -aG "
          "dialout "
          "$USER) and log in again");
    case EBUSY:
    case EWOULDBLOCK:
      return because("another program has it: close that first");
    default:
      return because(std::strerror(problem));
  }
}

/// Raw bytes, 8N1, no modem control lines except those for flow control. Source: termios(3).
bool make_raw(int descriptor, bool hardware_flow) {
  termios settings{};
  if (::tcgetattr(descriptor, &settings) != 0) return false;
  ::cfmakeraw(&settings);
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | PARENB | CRTSCTS);
  settings.c_cflag |= static_cast<tcflag_t>(CLOCAL | CREAD) | (hardware_flow ? CRTSCTS : 0);
  settings.c_cc[VMIN] = 1;  // an empty read then means that the line is gone
  settings.c_cc[VTIME] = 0;
  return ::tcsetattr(descriptor, TCSANOW, &settings) == 0;
}

}  // namespace

Result<SerialPort> open_serial_port(const SerialSettings& settings) {
  const std::string& device = settings.device;
  Descriptor descriptor(::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  const int number = descriptor.number();
  if (number < 0) return refusal(device, errno);
  if (::isatty(number) == 0)
    return Error{Errc::device, fmt::format("{}: is not a serial device", device)};
  // TIOCEXCL does not exclude root; this lock excludes other instances of this program.
  if (::flock(number, LOCK_EX | LOCK_NB) != 0) return refusal(device, errno);
  (void)::ioctl(number, TIOCEXCL);
  if (!make_raw(number, settings.hardware_flow)) return refusal(device, errno);
  const unsigned baud = set_baud(number, settings.baud);
  if (baud == 0)
    return Error{Errc::device, fmt::format("{}: refuses {} baud", device, settings.baud)};
  (void)::tcflush(number, TCIFLUSH);
  return SerialPort{std::make_unique<SerialFeed>(std::move(descriptor), device), baud};
}

}  // namespace proofmass::acquire
