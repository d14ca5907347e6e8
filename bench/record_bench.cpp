// Cost of recording: a card's rate in real time, with the wheel's estimates, and as fast as a
// source delivers, compared with plainly writing the same bytes.
//   record_bench [seconds of real time] [folder]
//
// In real time: 48 000 rows a second of 8 channels, then 1000 of 6 with the latency from a block's
// arrival to its estimate. Shares are of one core.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <string>
#include <unistd.h>
#include <vector>

#include "measure.hpp"
#include "proofmass/acquire/recorder.hpp"
#include "proofmass/estimate/live_wheel.hpp"

namespace {

using namespace proofmass;
using namespace proofmass::acquire;

const std::string card = "sim:wheel?rate=48000&sensors=4&axes=2";
const std::string kilohertz = "sim:wheel?rate=1000";

struct Cost {
  double processor_s = 0.0, wall_s = 0.0;
};

template <class Run>
Cost cost_of(Run run) {
  const auto start = std::chrono::steady_clock::now();
  const double processor_s = cpu_s();
  run();
  return {cpu_s() - processor_s,
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
}

[[noreturn]] void give_up(const std::string& message) {
  std::fprintf(stderr, "record_bench: %s\n", message.c_str());
  std::exit(1);
}

template <class T>
T needed(Result<T> result) {
  if (!result) give_up(result.error().message);
  return std::move(result).value();
}

std::string asked(const std::string& uri, double seconds) {
  return uri + "&seconds=" + std::to_string(seconds);
}

/// Reads a source to its end and discards the data.
std::size_t drain(const std::string& uri) {
  const auto source = needed(open_source(uri));
  Arrival arrival;
  std::size_t rows = 0;
  while (needed(source->read(arrival, std::chrono::milliseconds(100))) != Arrived::ended)
    rows += arrival.rows();
  return rows;
}

/// The wheel analysis of the first sensor and the opposite one.
Result<std::unique_ptr<LiveAnalysis>> wheel_analysis(const SourceHead& head) {
  const std::vector<Triad> triads = accelerometer_triads(head.recording);
  estimate::LiveWheelOptions options;
  options.sensors = {triads.front(), triads[triads.size() / 2]};
  options.rate_hz = head.recording.time.rate_hz;
  return estimate::live_wheel(options);
}

RecordSummary recorded(const std::string& uri,
                       const std::string& path,
                       const MakeAnalysis& analysis) {
  std::filesystem::remove(path);
  RecordOptions options;
  options.path = path;
  return needed(record([&] { return open_source(uri); }, options, {}, analysis));
}

void print_share(const char* what, const Cost& cost) {
  std::printf("  %-28s %5.1f %% of a core\n", what, 100.0 * cost.processor_s / cost.wall_s);
}

void in_real_time(const std::string& base, double seconds, const std::string& path) {
  const std::string uri = asked(base, seconds);
  std::printf("%s, in real time\n", uri.c_str());
  print_share("source alone", cost_of([&] { (void)drain(uri); }));
  print_share("recorded", cost_of([&] { (void)recorded(uri, path, {}); }));
  RecordSummary summary;
  print_share("recorded, with estimates",
              cost_of([&] { summary = recorded(uri, path, wheel_analysis); }));
  std::printf("  %llu rows, %llu lost, %.1f MB written, peak %.0f MiB\n",
              static_cast<unsigned long long>(summary.samples),
              static_cast<unsigned long long>(summary.lost),
              static_cast<double>(std::filesystem::file_size(path)) / 1e6, peak_mib());
  if (const auto& latency = summary.latency)
    std::printf(
        "  arrival to estimate: median %.2f ms, 99 %% %.2f ms, worst %.2f ms (%zu blocks)\n",
        1e3 * latency->median_s, 1e3 * latency->p99_s, 1e3 * latency->worst_s, latency->blocks);
  if (summary.lost > 0) give_up("rows were lost");
}

/// Writes the bytes of the file again by write() alone.
void write_plainly(const std::string& path, std::size_t bytes) {
  const std::vector<char> piece(std::size_t{1} << 20, '\1');
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file < 0) give_up(path + ": cannot be written");
  for (std::size_t left = bytes; left > 0;) {
    const ssize_t written = ::write(file, piece.data(), std::min(left, piece.size()));
    if (written <= 0) give_up(path + ": cannot be written");
    left -= static_cast<std::size_t>(written);
  }
  if (::fsync(file) != 0 || ::close(file) != 0) give_up(path + ": cannot be written");
}

void print_speed(const char* what, std::size_t rows, const Cost& cost) {
  const double count = static_cast<double>(rows) / 1e6;
  std::printf("  %-28s %6.2f million rows/s, %6.2f a second of processor\n", what,
              count / cost.wall_s, count / cost.processor_s);
}

void as_fast_as_it_goes(const std::string& path) {
  constexpr double seconds = 120.0;
  const std::string uri = asked(card, seconds) + "&speed=max";
  std::printf("%s\n", uri.c_str());
  std::size_t rows = 0;
  const Cost alone = cost_of([&] { rows = drain(uri); });
  print_speed("source alone", rows, alone);
  print_speed("recorded", rows, cost_of([&] { (void)recorded(uri, path, {}); }));
  const std::size_t bytes = std::filesystem::file_size(path);
  print_speed("write() of the same bytes", rows, cost_of([&] { write_plainly(path, bytes); }));
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 60.0;
  if (!(seconds > 0.0)) give_up("usage: record_bench [seconds of real time] [folder]");
  const std::filesystem::path folder = argc > 2 ? argv[2] : std::filesystem::temp_directory_path();
  const std::string path = folder / "proofmass_record_bench.mcap";
  in_real_time(card, seconds, path);
  in_real_time(kilohertz, seconds, path);
  as_fast_as_it_goes(path);
  std::filesystem::remove(path);
}
