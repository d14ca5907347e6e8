#include "proofmass/report/provenance.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "proofmass/report/json.hpp"
#include "proofmass/report/page/page.hpp"

namespace proofmass::report::provenance_test {
namespace {

using ::testing::HasSubstr;

Provenance some() {
  return {.command = "proofmass noise 'a <b>.csv' -",
          .options = {{"--unit", "g"}},
          .date = "2026-11-24T12:45:50Z",
          .commit = "0123456789ab",
          .host = "bench",
          .inputs = {{.path = "a <b>.csv", .bytes = 12'345, .sha256 = std::string(64, 'f')},
                     {.path = "-", .reason = "standard input is read once"}}};
}

TEST(Provenance, IsTheLastMemberOfADocumentThatIsOtherwiseTheSame) {
  const std::string plain = to_json({"noise", {"a.csv"}, {}}, {{"rows", Array{1, 2}}});
  auto document = nlohmann::ordered_json::parse(with_provenance(plain, some()));
  const auto& provenance = document["provenance"];
  EXPECT_EQ(provenance["command"], "proofmass noise 'a <b>.csv' -");
  EXPECT_EQ(provenance["options"]["--unit"], "g");
  EXPECT_EQ(provenance["inputs"][0]["bytes"], 12'345);
  EXPECT_EQ(provenance["inputs"][0]["sha256"], std::string(64, 'f'));
  EXPECT_FALSE(provenance["inputs"][1].contains("sha256"));
  EXPECT_EQ(std::prev(document.end()).key(), "provenance");
  document.erase("provenance");
  EXPECT_EQ(document, nlohmann::ordered_json::parse(plain));
}

TEST(Provenance, IsInTheFooterOfAPageAndEscaped) {
  const std::string page = page_with_provenance(
      html({.verb = "noise", .title = "a", .inputs = {"a </footer>"}, .conclusion = "b"}), some());
  const std::size_t footer = page.find("<footer>");
  ASSERT_NE(footer, std::string::npos);
  const std::string text = page.substr(footer);
  EXPECT_THAT(text, HasSubstr("Command: <code>proofmass noise &#39;a &lt;b&gt;.csv&#39; -</code>"));
  EXPECT_THAT(text, HasSubstr("2026-11-24T12:45:50Z on bench, source at commit 0123456789ab"));
  EXPECT_THAT(text, HasSubstr("12\u202f345 bytes, SHA-256 <code>ffff"));
  EXPECT_THAT(text, HasSubstr("-: no checksum: standard input is read once"));
}

}  // namespace
}  // namespace proofmass::report::provenance_test
