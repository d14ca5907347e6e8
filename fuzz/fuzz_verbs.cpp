// Recordings of 2 to 200 samples of any scale through every verb that reads one, from flags to
// document. The result must be a valid document, or a one-line error.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <system_error>
#include <unistd.h>
#include <vector>

#include "../apps/proofmass/cli/command_line.hpp"
#include "../apps/proofmass/cli/exit_status.hpp"
#include "../apps/proofmass/verb.hpp"

namespace {

using namespace proofmass;

// Flags of each verb; the recording's name is inserted after the verb, the folder before each
// output.
constexpr std::array command_lines = std::to_array<std::string_view>({
    "inspect",
    "convert -o out.csv",
    "convert -o out.mat",
    "noise",
    "noise --statistic totdev --taus all",
    "noise --data phase --confidence 0.999999",
    "drift",
    "drift --since-switch-on 3600",
    "drift --since-switch-on 1e6 --forecast 1e9",
    "calibrate --monte-carlo 20",
    "calibrate --means --monte-carlo 0",
    "calibrate --six-position --monte-carlo 0",
    "tumble",
    "tumble --rotating",
    "tumble --angles 0,90,180,270",
    "tilt",
    "tilt --base moving",
    "tilt --base still --no-gyro",
    "track",
    "track --axis x --gravity removed",
    "track --model pva --axis x --jerk-psd 1e-9",
    "track --same-place --take-as-acceleration",
    "wheel",
    "wheel --radius 0.1 --no-gyro",
    "wheel --spin-axis z --rim-radius 0.3",
    "motor --voltage az",
    "motor --voltage az --current ax --angle ay",
    "tune",
    "tune --model rest",
});

/// Folder of the recording and the results.
std::string& folder() {
  static std::string path;
  return path;
}

void require(bool kept) {
  if (!kept) std::abort();
}

/// Choices from the bytes of the input; zeros at its end.
class Choices {
 public:
  Choices(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  unsigned next() { return at_ < size_ ? data_[at_++] : 0u; }
  [[nodiscard]] bool are_left() const { return at_ < size_; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

void append(std::string& text, double value, char end) {
  std::array<char, 32> figure;
  const auto last = std::to_chars(figure.data(), figure.data() + figure.size(), value).ptr;
  text.append(figure.data(), last);
  text += end;
}

/// A sample of the recording: from the input, or that of a rotating wheel with a little noise.
double figure_of(Choices& choices, std::size_t row, unsigned axis, double scale) {
  const double turn = 0.2 * static_cast<double>(row);
  const std::array wheel{9.8 * std::sin(turn), 9.8 * std::cos(turn), 0.05};
  const auto noise = static_cast<double>((row * 7919 + axis * 104729) % 13) * 1e-3;
  if (!choices.are_left()) return scale * (wheel[axis] + noise);
  const unsigned byte = choices.next();
  constexpr std::array odd{std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(),
                           3e34,
                           5e-324,
                           -0.0,
                           1e300};
  if (byte >= 256 - odd.size()) return odd[255 - byte];
  return scale * (0.08 * (static_cast<double>(byte) - 125.0) + noise);
}

std::string recording_of(Choices& choices) {
  const std::size_t rows = 2 + choices.next() % 199;
  const double scale = std::pow(10.0, (static_cast<int>(choices.next()) - 128) / 8);
  const double rate_hz = std::pow(10.0, (static_cast<int>(choices.next()) - 96) / 32.0);
  const unsigned odd_step = choices.next();
  std::string text = "t (s),ax (m/s^2),ay (m/s^2),az (m/s^2)\n";
  double time_s = 0.0;
  for (std::size_t row = 0; row < rows; ++row) {
    append(text, time_s, ',');
    for (unsigned axis = 0; axis < 3; ++axis)
      append(text, figure_of(choices, row, axis, scale), axis < 2 ? ',' : '\n');
    // At one row the stamps repeat, jump, or run backwards.
    const double steps = row == odd_step ? static_cast<double>(odd_step % 5) * 40.0 - 40.0 : 1.0;
    time_s += steps / rate_hz;
  }
  return text;
}

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words;
  while (!line.empty()) {
    const std::size_t end = std::min(line.find(' '), line.size());
    words.emplace_back(line.substr(0, end));
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return words;
}

/// A refusal must not come from a library, a violated contract or the language's runtime.
void check_refusal(std::string_view message) {
  require(!message.empty() && message.find('\n') == std::string_view::npos);
  for (const std::string_view foreign : {"boost", "Error in function", "contract", "std::"})
    require(message.find(foreign) == std::string_view::npos);
}

void run_command(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  // A flag that no longer exists is a fault of the table above: the exception ends the program.
  const auto command =
      app::parse_command_line(static_cast<int>(arguments.size()), arguments.data());
  require(command.has_value());
  try {
    command->run();
  } catch (const app::Failure& failure) {
    return check_refusal(failure.what());
  }
  std::ifstream file(folder() + "/document.json", std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  require(nlohmann::json::accept(text));  // rejects NaN
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  folder() = std::filesystem::exists("/dev/shm") ? "/dev/shm" : "/tmp";
  folder() += "/proofmass-fuzz-XXXXXX";
  require(::mkdtemp(folder().data()) != nullptr);
  std::atexit([] {
    std::error_code failed;
    std::filesystem::remove_all(folder(), failed);
  });
  require(std::freopen("/dev/null", "w", stdout) != nullptr);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Choices choices(data, size);
  std::vector<std::string> words = words_of(command_lines[choices.next() % command_lines.size()]);
  const std::string recording = folder() + "/r.csv";
  std::ofstream(recording, std::ios::binary) << recording_of(choices);
  for (std::string& word : words)
    if (word.starts_with("out.")) word = folder() + "/" + word;
  words.insert(words.begin(), "proofmass");
  words.insert(words.begin() + 2, recording);
  for (const std::string& word :
       {std::string("--json"), folder() + "/document.json", std::string("--quiet")})
    words.push_back(word);
  run_command(std::move(words));
  return 0;
}
