// Reads TDMS files of all value layouts, warm and on one core, a block of rows at a time, compared
// with the minimum work of any reader on the same bytes in the same run: copying them from the
// kernel's cache, and converting them to doubles in a bare loop.
//
//   tdms_bench [MiB of values, 256]
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "measure.hpp"
#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/tdms/group_reader.hpp"
#include "proofmass/io/tdms/specimens.hpp"

namespace {

using namespace proofmass;
using namespace proofmass::io;

constexpr std::size_t channels = 6;

struct Layout {
  const char* name;
  std::uint32_t type;
  std::size_t bytes;
  bool is_interleaved;
  std::size_t rows_a_chunk;  ///< 0: all in one
};

template <class T>
std::string values_of(std::size_t count) {
  std::mt19937 random(1);
  std::vector<T> values(count);
  for (T& value : values) value = static_cast<T>(static_cast<int>(random() % 60000) - 30000);
  return {reinterpret_cast<const char*>(values.data()), count * sizeof(T)};
}

std::string file_of(const Layout& layout, std::size_t rows) {
  const std::size_t in_chunk = layout.rows_a_chunk == 0 ? rows : layout.rows_a_chunk;
  specimen::TdmsList list;
  for (std::size_t c = 0; c < channels; ++c)
    list.channel("/'g'/'" + std::to_string(c) + "'", layout.type, in_chunk);
  const std::size_t count = rows / in_chunk * in_chunk * channels;
  const std::string values = layout.type == 10  ? values_of<double>(count)
                             : layout.type == 9 ? values_of<float>(count)
                                                : values_of<std::int16_t>(count);
  return specimen::tdms_segment(
      specimen::tdms_whole | (layout.is_interleaved ? specimen::tdms_interleaved : 0U),
      list.bytes(), values);
}

double best_of_five(const std::function<void()>& work) {
  double best_s = 1e300;
  for (int i = 0; i < 5; ++i) {
    const double start_s = cpu_s();
    work();
    best_s = std::min(best_s, cpu_s() - start_s);
  }
  return best_s;
}

/// All rows of the first table, 65 536 at a time.
double read_table(const std::string& path) {
  auto random =
      random_bytes_of(std::make_unique<PeekSource>(std::move(open_file(path)).value()), Progress{});
  auto contents = std::move(tdms::read_contents(std::move(random).value())).value();
  auto table = std::move(tdms::open_table(contents, 0)).value();
  std::vector<std::vector<double>> block(channels, std::vector<double>(65'536));
  const std::vector<std::span<double>> into(block.begin(), block.end());
  double sum = 0.0;
  while (true) {
    const std::size_t rows = table->read(into).value();
    if (rows == 0) return sum;
    sum += block[channels - 1][rows - 1];
  }
}

/// Reads the same bytes piece by piece.
double copy_file(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "rb");
  std::setvbuf(file, nullptr, _IONBF, 0);
  std::vector<char> piece(std::size_t{256} << 10);
  double sum = 0.0;
  while (const std::size_t count = std::fread(piece.data(), 1, piece.size(), file))
    sum += piece[count - 1];
  std::fclose(file);
  return sum;
}

/// Consecutive values in memory, converted to doubles in a small block.
template <class T>
double convert(const std::string& bytes) {
  std::vector<double> block(16'384);
  double sum = 0.0;
  const std::size_t count = bytes.size() / sizeof(T);
  for (std::size_t at = 0; at < count; at += block.size()) {
    const std::size_t rows = std::min(block.size(), count - at);
    const char* from = bytes.data() + at * sizeof(T);
    for (std::size_t i = 0; i < rows; ++i) {
      T value;
      std::memcpy(&value, from + i * sizeof(T), sizeof value);
      block[i] = static_cast<double>(value);
    }
    sum += block[rows - 1];
  }
  return sum;
}

double convert_any(const Layout& layout, const std::string& bytes) {
  if (layout.type == 10) return convert<double>(bytes);
  return layout.type == 9 ? convert<float>(bytes) : convert<std::int16_t>(bytes);
}

/// A file of segments with one value of each channel.
void run_fragmented(const std::string& path, std::size_t segments) {
  specimen::TdmsList list;
  for (std::size_t c = 0; c < channels; ++c)
    list.channel("/'g'/'" + std::to_string(c) + "'", 10, 1);
  const std::string metadata = list.bytes();
  const std::string segment =
      specimen::tdms_segment(specimen::tdms_whole, metadata, values_of<double>(channels));
  {
    std::ofstream file(path, std::ios::binary);
    for (std::size_t k = 0; k < segments; ++k) file << segment;
  }
  double sum = 0.0;
  const double reader_s = best_of_five([&] { sum += read_table(path); });
  std::printf("%-34s %zu segments in %.3f s, %.0f ns each   (checksum %g)\n",
              "one value a segment and channel", segments, reader_s,
              1e9 * reader_s / static_cast<double>(segments), sum);
}

void run(const Layout& layout, const std::string& path, std::size_t bytes) {
  const std::string content = file_of(layout, bytes / channels / layout.bytes);
  std::ofstream(path, std::ios::binary) << content;
  const double mb = static_cast<double>(content.size()) / 1e6;
  double sum = 0.0;
  const double reader_s = best_of_five([&] { sum += read_table(path); });
  const double copy_s = best_of_five([&] { sum += copy_file(path); });
  const double convert_s = best_of_five([&] { sum += convert_any(layout, content); });
  std::printf(
      "%-34s reader %6.0f MB/s   copy from the cache %6.0f MB/s   bare conversion %6.0f MB/s   "
      "(checksum %g)\n",
      layout.name, mb / reader_s, mb / copy_s, mb / convert_s, sum);
}

}  // namespace

int main(int argc, char** argv) {
  const double mib = argc > 1 ? std::strtod(argv[1], nullptr) : 256.0;
  const auto bytes = static_cast<std::size_t>(mib * 1048576.0);
  const std::string path =
      (std::filesystem::temp_directory_path() / "proofmass_tdms_bench.tdms").string();
  for (const Layout& layout : {Layout{"f64, channel after channel", 10, 8, false, 0},
                               Layout{"f64, interleaved", 10, 8, true, 0},
                               Layout{"f64, chunks of 100 values", 10, 8, false, 100},
                               Layout{"f32, channel after channel", 9, 4, false, 0},
                               Layout{"f32, interleaved", 9, 4, true, 0},
                               Layout{"i16, channel after channel", 2, 2, false, 0},
                               Layout{"i16, interleaved", 2, 2, true, 0}})
    run(layout, path, bytes);
  run_fragmented(path, 100'000);
  std::filesystem::remove(path);
  return 0;
}
