#include <boost/asio/buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "proofmass/serve/folder.hpp"
#include "proofmass/serve/http/gate.hpp"
#include "proofmass/serve/http/request_head.hpp"

// A request as sent by a peer: parser, access check and target, and the folder that a name in the
// request must not leave.

using namespace proofmass::serve;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace http = boost::beast::http;
  static const Gate gate{"0123456789abcdef0123456789abcdef", "127.0.0.1", 8080};
  static const Folder folder = Folder::open("/usr/share").value();
  http::request_parser<http::empty_body> parser;
  parser.header_limit(16U << 10);
  boost::system::error_code failed;
  parser.put(boost::asio::buffer(data, size), failed);
  if (!parser.is_header_done()) return 0;
  const RequestHead head = head_of(parser.get());
  const auto refused = refusal(gate, head);
  if (!refused && (!head.host || head.host->find("8080") == std::string::npos)) std::abort();
  const auto target = parse_target(head.target);
  if (!target) return 0;
  const auto found = folder.existing(target->find("file").value_or(target->path));
  if (found && (found->find("..") == 0 || found->starts_with('/'))) std::abort();
  return 0;
}
