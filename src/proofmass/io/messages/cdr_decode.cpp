#include <algorithm>
#include <bit>

#include "proofmass/io/arrays/figure_type.hpp"
#include "proofmass/io/messages/cdr_plan.hpp"

namespace proofmass::io {
namespace {

/// Reads the bytes after the encapsulation header.
class CdrBytes {
 public:
  CdrBytes(std::string_view bytes, std::size_t most_alignment, bool big_endian)
      : bytes_(bytes), most_alignment_(most_alignment), big_endian_(big_endian) {}

  void align(std::size_t size) {
    const std::size_t to = std::min(size, most_alignment_);
    at_ = (at_ + to - 1) / to * to;
  }
  [[nodiscard]] std::size_t left() const { return at_ < bytes_.size() ? bytes_.size() - at_ : 0; }
  /// Skips `count` items of `size` bytes; false if there are fewer.
  bool skip(std::uint64_t count, std::size_t size) {
    if (count > left() / size) return false;
    at_ += static_cast<std::size_t>(count) * size;
    return true;
  }
  /// Precondition: the bytes are available.
  double figure(char kind, std::size_t size) {
    const double value = load_figure(bytes_.data() + at_, {kind, size, big_endian_});
    at_ += size;
    return value;
  }
  bool length(std::uint64_t& value) {
    align(4);
    if (left() < 4) return false;
    value = static_cast<std::uint64_t>(figure('u', 4));
    return true;
  }

 private:
  std::string_view bytes_;
  std::size_t most_alignment_;
  bool big_endian_;
  std::size_t at_ = 0;
};

bool follow(const std::vector<CdrStep>& steps, CdrBytes& bytes, std::span<double> columns);

bool follow(const CdrStep& step, CdrBytes& bytes, std::span<double> columns) {
  std::uint64_t count = step.count;
  if (step.is_sequence && !bytes.length(count)) return false;
  if (step.what == CdrStep::What::figures) {
    if (count > 0) bytes.align(step.bytes);
    if (!step.column) return bytes.skip(count, step.bytes);
    if (count > bytes.left() / step.bytes) return false;
    for (std::size_t i = 0; i < count; ++i)
      columns[*step.column + i] = bytes.figure(step.kind, step.bytes);
    return true;
  }
  // Each text and each message has at least one byte, so that a count cannot exceed the bytes.
  for (std::uint64_t i = 0; i < count; ++i) {
    if (step.what == CdrStep::What::text) {
      std::uint64_t size = 0;
      if (!bytes.length(size) || !bytes.skip(size, 1)) return false;
    } else if (bytes.left() == 0 || !follow(step.inner, bytes, columns)) {
      return false;
    }
  }
  return true;
}

bool follow(const std::vector<CdrStep>& steps, CdrBytes& bytes, std::span<double> columns) {
  return std::ranges::all_of(steps,
                             [&](const CdrStep& step) { return follow(step, bytes, columns); });
}

}  // namespace

Status decode_cdr(std::string_view message,
                  CdrLayout layout,
                  const CdrPlan& plan,
                  std::span<double> columns) {
  bool big_endian = false;
  std::size_t alignment = 1;
  if (layout == CdrLayout::xcdr) {
    if (message.size() < 4) return Error{Errc::corrupt, "breaks off within its head"};
    const int kind =
        static_cast<unsigned char>(message[0]) << 8 | static_cast<unsigned char>(message[1]);
    constexpr int plain_1 = 0x0000;
    constexpr int plain_2 = 0x0006;
    if ((kind & ~1) != plain_1 && (kind & ~1) != plain_2)
      return Error{Errc::unsupported, "is of an encapsulation other than plain CDR"};
    big_endian = (kind & 1) == 0;
    alignment = (kind & ~1) == plain_1 ? 8 : 4;
    message.remove_prefix(4);
  }
  CdrBytes bytes(message, alignment, big_endian);
  if (!follow(plan.steps, bytes, columns))
    return Error{Errc::corrupt, "breaks off before its last field"};
  return Done{};
}

}  // namespace proofmass::io
