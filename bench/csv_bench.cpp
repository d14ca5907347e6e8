// Reads one table three ways, on one core and in one run: with the library from a file, with a bare
// fast_float loop over the text in memory, and with the same loop around std::from_chars. The bare
// loops know the layout, check nothing and store the doubles in one vector, the minimum work of any
// reader.
//
//   csv_bench [MiB of text, 200]
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fast_float/fast_float.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "proofmass/io/read_recording.hpp"

namespace {

/// Format of a table's columns.
struct Table {
  const char* name;
  const char* header;
  std::function<void(std::string&, std::size_t)> append_row;
};

std::mt19937_64& generator() {
  static std::mt19937_64 random(5);
  return random;
}

double normal() {
  static std::normal_distribution<double> distribution;
  return distribution(generator());
}

template <class... Format>
void append(std::string& text, double value, Format... format) {
  char buffer[64];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, format...);
  text.append(buffer, end.ptr);
}

const Table tables[] = {
    {"4 columns of 5 decimals", "time (s),ax (g),ay (g),az (g)\n",
     [](std::string& text, std::size_t k) {
       append(text, static_cast<double>(k) / 200.0, std::chars_format::fixed, 3);
       for (int c = 0; c < 3; ++c) {
         text += ',';
         append(text, normal(), std::chars_format::fixed, 5);
       }
       text += '\n';
     }},
    {"7 columns of 16 digits", "SampleTime (us),ax,ay,az,gx,gy,gz\n",
     [](std::string& text, std::size_t k) {
       text += std::to_string(2167082953 + 8333 * k);
       for (int c = 0; c < 6; ++c) {
         text += ',';
         append(text, 10.0 * normal());
       }
       text += '\n';
     }},
};

/// Common part of both bare loops: number, separator, number, …
template <class Parse>
std::vector<double> bare_loop(const std::string& text, std::size_t from, Parse parse) {
  std::vector<double> values;
  values.reserve(text.size() / 5);
  const char* p = text.data() + from;
  const char* const end = text.data() + text.size();
  while (p < end) {
    double value = 0.0;
    p = parse(p, end, value) + 1;
    values.push_back(value);
  }
  return values;
}

/// Processor time of the work in seconds, including the kernel's part; other processes do not
/// count.
double seconds_of(const std::function<void()>& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// Peak or current memory of this process in kilobytes.
double memory_kb(const char* field) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(field))
      return std::strtod(line.c_str() + std::string(field).size() + 1, nullptr);
  return 0.0;
}

void run(const Table& table, std::size_t bytes) {
  std::string text = table.header;
  const std::size_t from = text.size();
  for (std::size_t k = 0; text.size() < bytes; ++k) table.append_row(text, k);
  const auto path = std::filesystem::temp_directory_path() / "proofmass_csv_bench.csv";
  std::ofstream(path, std::ios::binary) << text;
  const double mb = static_cast<double>(text.size()) / 1e6;

  // The best of five of each, in turn, so that a slow phase of the machine affects all three.
  double checksum = 0.0;
  double reader_s = 1e300;
  double fast_float_s = 1e300;
  double from_chars_s = 1e300;
  for (int i = 0; i < 5; ++i) {
    reader_s = std::min(reader_s, seconds_of([&] {
                          const auto read = proofmass::io::read_recording(path.string(), {});
                          checksum += read.value().channels.back().values.back();
                        }));
    fast_float_s = std::min(
        fast_float_s, seconds_of([&] {
          checksum -= bare_loop(text, from, [](const char* p, const char* end, double& value) {
                        return fast_float::from_chars(p, end, value).ptr;
                      }).back();
        }));
    from_chars_s = std::min(
        from_chars_s, seconds_of([&] {
          checksum += bare_loop(text, from, [](const char* p, const char* end, double& value) {
                        return std::from_chars(p, end, value).ptr;
                      }).back();
        }));
  }
  std::printf(
      "%-26s reader %6.0f MB/s   fast_float loop %6.0f MB/s   std::from_chars loop %6.0f MB/s"
      "   (checksum %g)\n",
      table.name, mb / reader_s, mb / fast_float_s, mb / from_chars_s, checksum);
  std::filesystem::remove(path);
}

/// Peak memory of one read over the size of the stored doubles.
int measure_memory(const std::string& path) {
  const double before_kb = memory_kb("VmRSS:");
  const auto read = proofmass::io::read_recording(path, {});
  const double peak_kb = memory_kb("VmHWM:");
  if (!read) {
    std::fprintf(stderr, "%s\n", read.error().message.c_str());
    return 1;
  }
  std::size_t kept = read->time.stamps_s.size();
  for (const auto& channel : read->channels) kept += channel.values.size();
  const double kept_kb = static_cast<double>(kept) * 8.0 / 1024.0;
  std::printf("%s: %.1f MiB of doubles kept, %.1f MiB more than before at the peak: %.3f times\n",
              path.c_str(), kept_kb / 1024.0, (peak_kb - before_kb) / 1024.0,
              (peak_kb - before_kb) / kept_kb);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  // "memory FILE" is a separate run: the peak is the process's.
  if (argc == 3 && std::string(argv[1]) == "memory") return measure_memory(argv[2]);
  const double mib = argc > 1 ? std::strtod(argv[1], nullptr) : 200.0;
  for (const Table& table : tables) run(table, static_cast<std::size_t>(mib * 1048576.0));
  return 0;
}
