#include "proofmass/serve/page.hpp"

#include <array>
#include <fmt/format.h>
#include <openssl/evp.h>

namespace proofmass::serve {
namespace {

std::string hash_of(std::string_view text) {
  std::array<unsigned char, 32> digest{};
  EVP_Digest(text.data(), text.size(), digest.data(), nullptr, EVP_sha256(), nullptr);
  std::array<unsigned char, 45> base64{};
  EVP_EncodeBlock(base64.data(), digest.data(), static_cast<int>(digest.size()));
  return fmt::format(" 'sha256-{}'", reinterpret_cast<const char*>(base64.data()));
}

// The hashes of what stands between <tag …> and </tag>.
std::string hashes(std::string_view page, std::string_view tag) {
  const std::string open = fmt::format("<{}", tag), close = fmt::format("</{}>", tag);
  std::string all;
  for (std::size_t at = page.find(open); at != std::string_view::npos; at = page.find(open, at)) {
    const std::size_t begin = page.find('>', at) + 1, end = page.find(close, begin);
    if (begin == 0 || end == std::string_view::npos) break;
    all += hash_of(page.substr(begin, end - begin));
    at = end;
  }
  return all.empty() ? " 'none'" : all;
}

}  // namespace

std::string content_security_policy(std::string_view page) {
  return fmt::format(
      "default-src 'none'; script-src{}; style-src{}; img-src 'self' data: blob:; "
      "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
      hashes(page, "script"), hashes(page, "style"));
}

}  // namespace proofmass::serve
