// Speed of reading and writing MCAP files of our own channel, from the page cache, checksums
// verified: MB of samples a second of processor time, compared with copying those bytes and with
// zlib's checksum.
//   mcap_bench [MiB of samples]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>
#include <zlib.h>

#include "measure.hpp"
#include "proofmass/io/bytes/crc32.hpp"
#include "proofmass/io/mcap/reader.hpp"
#include "proofmass/io/reading/recording_writers.hpp"

namespace {

using namespace proofmass;

/// Processor time, which other programs on the machine disturb least.
template <class Run>
double seconds_of(Run run) {
  const double start = cpu_s();
  run();
  return cpu_s() - start;
}

[[noreturn]] void give_up(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  std::exit(1);
}

/// Three channels of noise at 1 kHz; with stamps on request.
void write(const std::string& path, std::size_t rows, bool has_stamps) {
  constexpr std::size_t block_rows = 8192;
  Recording recording;
  recording.time = {TimeSource::given_rate, "", 1000.0, {}, 1'700'000'000'000'000'000};
  for (const char* name : {"acc_x", "acc_y", "acc_z"})
    recording.channels.push_back({name, *parse_unit("m/s^2"), {}});
  std::vector<double> values(block_rows);
  for (std::size_t k = 0; k < block_rows; ++k) values[k] = std::sin(static_cast<double>(k * k));
  std::vector<double> stamps(block_rows);
  auto file = io::create_file(path);
  if (!file) give_up(file.error());
  auto opened = io::mcap::create(std::move(file).value(), {recording, has_stamps}, {});
  if (!opened) give_up(opened.error());
  const auto writer = std::move(opened).value();
  for (std::size_t k = 0; k < rows; k += block_rows) {
    Block block;
    block.first = k;
    block.channels.assign(3, View<double>(values));
    for (std::size_t i = 0; has_stamps && i < block_rows; ++i)
      stamps[i] = static_cast<double>(k + i) / 1000.0;
    if (has_stamps) block.stamps_s = stamps;
    if (const Status written = writer->write(block); !written) give_up(written.error());
  }
  if (const Status finished = writer->finish(recording); !finished) give_up(finished.error());
}

/// Reads all rows and returns their number.
std::size_t read(const std::string& path) {
  auto source = io::open_file(path);
  if (!source) give_up(source.error());
  auto peek = std::make_unique<io::PeekSource>(std::move(source).value());
  auto file = io::mcap::open(std::move(peek), {});
  if (!file) give_up(file.error());
  const auto tables = std::move(file).value();
  auto opened = tables->open(0, {});
  if (!opened) give_up(opened.error());
  const auto reader = std::move(opened).value();
  io::RawRows rows;
  std::size_t count = 0;
  for (;;) {
    if (const Status next = reader->next(8192, rows); !next) give_up(next.error());
    if (rows.channels.front().empty()) return count;
    count += rows.channels.front().size();
  }
}

void run(double mib, bool has_stamps) {
  const std::size_t columns = has_stamps ? 4 : 3;
  const auto rows = static_cast<std::size_t>(mib * 1048576.0 / static_cast<double>(8 * columns));
  const std::string path = std::filesystem::temp_directory_path() / "proofmass_bench.mcap";
  const double write_s = seconds_of([&] { write(path, rows, has_stamps); });
  const double mb = static_cast<double>(std::filesystem::file_size(path)) / 1e6;
  double read_s = 1e9;
  std::size_t count = 0;
  for (int repetition = 0; repetition < 3; ++repetition)
    read_s = std::min(read_s, seconds_of([&] { count = read(path); }));
  std::printf("%-22s read %6.0f MB/s   written %6.0f MB/s   (%zu rows, peak %.0f MiB)\n",
              has_stamps ? "with stamps" : "at an even rate", mb / read_s, mb / write_s, count,
              peak_mib());
  std::filesystem::remove(path);
}

/// One mebibyte at a time, which stays in the cache as a chunk does.
void run_references() {
  std::string chunk(std::size_t{1} << 20, '\1');
  std::string copy = chunk;
  constexpr int times = 500;
  unsigned checksum = 0;
  const auto rate = [&](auto&& once) {
    return static_cast<double>(times) * static_cast<double>(chunk.size()) / 1e6 / seconds_of([&] {
             for (int i = 0; i < times; ++i) {
               ++chunk[static_cast<std::size_t>(i)];
               once();
             }
           });
  };
  const double copied = rate([&] {
    std::memcpy(copy.data(), chunk.data(), chunk.size());
    checksum += static_cast<unsigned>(copy[7]);
  });
  const double ours = rate([&] { checksum += io::crc32(0, chunk); });
  const double zlib = rate([&] {
    checksum += static_cast<unsigned>(
        ::crc32(0, reinterpret_cast<const Bytef*>(chunk.data()), static_cast<uInt>(chunk.size())));
  });
  std::printf("%-22s memcpy %6.0f MB/s   crc32 %6.0f MB/s   zlib's crc32 %6.0f MB/s   (%u)\n",
              "references", copied, ours, zlib, checksum);
}

}  // namespace

int main(int argc, char** argv) {
  const double mib = argc > 1 ? std::strtod(argv[1], nullptr) : 512.0;
  run_references();
  run(mib, false);
  run(mib, true);
  return 0;
}
