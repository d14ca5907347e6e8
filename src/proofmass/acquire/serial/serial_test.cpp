#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <thread>
#include <unistd.h>
#include <vector>

#include "proofmass/acquire/serial/find.hpp"
#include "proofmass/acquire/serial/port.hpp"
#include "proofmass/acquire/source.hpp"

namespace proofmass::acquire::serial_test {
namespace {

using namespace std::chrono_literals;

/// A simulated device: what is written to it is received from the port.
class FakeDevice {
 public:
  FakeDevice() : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    EXPECT_EQ(::grantpt(master_), 0);
    EXPECT_EQ(::unlockpt(master_), 0);
    port_ = ::ptsname(master_);
  }
  FakeDevice(const FakeDevice&) = delete;
  FakeDevice& operator=(const FakeDevice&) = delete;
  ~FakeDevice() { unplug(); }

  [[nodiscard]] std::string uri(const std::string& settings = "") const {
    return "serial:" + port_ + "?" + settings;
  }
  [[nodiscard]] const std::string& port() const { return port_; }
  void send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t sent = ::write(master_, bytes.data(), bytes.size());
      ASSERT_GT(sent, 0);
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
  }
  void unplug() {
    if (master_ >= 0) ::close(master_);
    master_ = -1;
  }

 private:
  int master_;
  std::string port_;
};

/// Sends while the source is opened, which discards earlier input.
Result<std::unique_ptr<Source>> open_while_sending(const FakeDevice& device,
                                                   const std::string& settings,
                                                   const std::string& text) {
  std::atomic<bool> is_open = false;
  std::jthread sender([&] {
    while (!is_open) {
      device.send(text);
      std::this_thread::sleep_for(20ms);
    }
  });
  auto source = open_source(device.uri(settings), {.patience = 60s});
  is_open = true;
  return source;
}

/// Reads until a condition holds, which it eventually does.
template <class Until>
Error read_until(Source& source, Until until) {
  Arrival arrival;
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  while (std::chrono::steady_clock::now() < deadline) {
    const auto arrived = source.read(arrival, 50ms);
    if (!arrived) return arrived.error();
    if (until(arrival)) return {Errc::device, "done"};
  }
  return {Errc::device, "nothing came in a minute"};
}

TEST(SerialSource, ReadsLinesAndSaysWhatWasGranted) {
  const FakeDevice device;
  const auto source =
      open_while_sending(device, "baud=230400&columns=x (g),y&rate=50", "0.5,2\n").value();
  EXPECT_EQ(source->head().recording.format, "serial");
  EXPECT_EQ(source->head().settings[0], std::pair(std::string("baud"), std::string("230400")));
  EXPECT_EQ(source->head().recording.channels[0].unit.symbol, "g");
  EXPECT_EQ(source->head().recording.time.rate_hz, 50.0);
  EXPECT_TRUE(source->head().is_paced);
  Arrival arrival;
  ASSERT_EQ(source->read(arrival, 60s).value(), Arrived::rows) << "the first rows are kept";
  EXPECT_EQ(arrival.channels[0].front(), 0.5);
  EXPECT_GT(arrival.host_ns, 0);
}

TEST(SerialSource, HasItsRowsAfterTheyCameAndNothingElse) {
  const FakeDevice device;
  const auto source = open_while_sending(device, "time=none", "1,2\n").value();
  device.send("7,8\n9,10\n");
  std::vector<double> last;
  const Error end = read_until(*source, [&](const Arrival& arrival) {
    if (arrival.rows() > 0) last = {arrival.channels[0].back(), arrival.channels[1].back()};
    return last == std::vector<double>{9, 10};
  });
  EXPECT_EQ(end.message, "done");
  Arrival arrival;
  EXPECT_EQ(source->read(arrival, 1ms).value(), Arrived::nothing);
  EXPECT_EQ(arrival.rows(), 0u);
}

TEST(SerialSource, ThatIsUnpluggedSaysSoAfterItsLastRows) {
  FakeDevice device;
  const auto source = open_while_sending(device, "time=none", "1,2\n").value();
  device.send("7,8\n");
  const Error done = read_until(*source, [](const Arrival& arrival) {
    return arrival.rows() > 0 && arrival.channels[0].back() == 7.0;
  });
  ASSERT_EQ(done.message, "done");
  device.unplug();
  const Error end = read_until(*source, [](const Arrival&) { return false; });
  EXPECT_EQ(end.code, Errc::device);
  EXPECT_EQ(end.message, device.port() + " was unplugged");
}

TEST(SerialSource, LosesNothingOfThreeSecondsAtAKilohertz) {
  const FakeDevice device;
  constexpr int rows = 3000;
  const std::string settings = "columns=t_us,n,a,b,c,d,e,f&time=t_us&counter=n";
  const auto source = open_while_sending(device, settings, "0,0,0,0,0,0,0,0\n").value();
  const auto row = [](int k) { return fmt::format("{},{},{},1,2,3,4,5\n", 1000 * k, k, 0.5 * k); };
  std::jthread sender([&] {
    for (int k = 1; k <= rows; ++k) device.send(row(k));
  });
  double next = 1.0;
  std::uint64_t lost = 0;
  const Error end = read_until(*source, [&](const Arrival& arrival) {
    EXPECT_EQ(arrival.device_ns.size(), arrival.rows());
    for (std::size_t r = 0; r < arrival.rows(); ++r) {
      const double n = arrival.channels[0][r];
      if (n == 0.0) continue;
      EXPECT_EQ(n, next++);
      EXPECT_EQ(arrival.channels[1][r], 0.5 * n);
      EXPECT_EQ(arrival.device_ns[r], static_cast<std::int64_t>(n) * 1'000'000);
      lost += r == 0 && n > 1.0 ? arrival.lost_before : 0;
    }
    return next > rows;
  });
  EXPECT_EQ(end.message, "done");
  EXPECT_EQ(lost, 0u);
}

TEST(SerialSource, BelongsToOneReader) {
  const FakeDevice device;
  const auto source = open_while_sending(device, "", "1,2\n").value();
  const auto second = open_source(device.uri(), {.patience = 10ms});
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("another program has it"), std::string::npos);
}

TEST(SerialSource, SaysWhyItCannot) {
  const auto refusal = [](const std::string& uri) {
    const auto source = open_source(uri, {.patience = 10ms});
    return source ? std::string() : source.error().message;
  };
  EXPECT_NE(refusal("serial:/dev/no-such-port").find("is it plugged in?"), std::string::npos);
  EXPECT_NE(refusal("serial:/dev/null").find("is not a serial device"), std::string::npos);
  EXPECT_NE(refusal("serial:").find("expected a device"), std::string::npos);
  EXPECT_NE(refusal("serial:/dev/null?baud=fast").find("baud=fast"), std::string::npos);
  EXPECT_NE(refusal("serial:/dev/null?flow=soft").find("expected none, hard"), std::string::npos);
  EXPECT_NE(refusal("serial:/dev/null?boud=1").find("no such setting"), std::string::npos);
  const FakeDevice silent;
  EXPECT_NE(refusal(silent.uri()).find("nothing came within 0.01 s"), std::string::npos);
}

TEST(SerialSource, GivesUpWhenItIsTold) {
  const FakeDevice silent;
  const auto source = open_source(silent.uri(), {.patience = 600s, .stopped = [] { return true; }});
  ASSERT_FALSE(source);
  EXPECT_NE(source.error().message.find("stopped"), std::string::npos);
}

TEST(SerialPort, TakesRatesWithoutAName) {
  const FakeDevice device;
  const auto port = open_serial_port({.device = device.port(), .baud = 250'123});
  ASSERT_TRUE(port) << port.error().message;
  EXPECT_EQ(port->baud, 250'123u);
}

TEST(SerialDevices, AreFoundByTheirLastingNames) {
  namespace fs = std::filesystem;
  const fs::path root = fs::path(testing::TempDir()) / fmt::format("serial_devices_{}", ::getpid());
  fs::create_directories(root / "dev/serial/by-id");
  fs::create_directories(root / "sys/devices/usb1/1-1/1-1:1.0");
  fs::create_directories(root / "sys/class/tty/ttyACM0");
  for (const char* name : {"ttyACM0", "ttyUSB3", "ttyS0", "null"})
    std::ofstream(root / "dev" / name);
  fs::create_symlink("../../ttyACM0", root / "dev/serial/by-id/usb-Uno");
  fs::create_symlink("../../gone", root / "dev/serial/by-id/usb-Gone");
  fs::create_symlink(root / "sys/devices/usb1/1-1/1-1:1.0", root / "sys/class/tty/ttyACM0/device");
  std::ofstream(root / "sys/devices/usb1/1-1/product") << "Uno\n";
  std::ofstream(root / "sys/devices/usb1/1-1/manufacturer") << "Arduino\n";
  const auto found = serial_devices(root / "dev", root / "sys");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].uri, "serial:" + (root / "dev/serial/by-id/usb-Uno").string());
  EXPECT_EQ(found[0].what, "Arduino Uno, ttyACM0");
  EXPECT_EQ(found[1].uri, "serial:" + (root / "dev/ttyUSB3").string());
  EXPECT_TRUE(serial_devices(root / "nowhere", root).empty());
  fs::remove_all(root);
}

}  // namespace
}  // namespace proofmass::acquire::serial_test
