#include "proofmass/acquire/source.hpp"

#include <gtest/gtest.h>

// An actual card is tested in the virtual machine of rig/iio-vm.
namespace proofmass::acquire::comedi_source_test {
namespace {

std::string opening_error(const std::string& uri, Errc code) {
  const auto source = open_source(uri);
  if (source) return "it opened";
  EXPECT_EQ(source.error().code, code) << source.error().message;
  return source.error().message;
}

TEST(ComediSource, SaysThatThereIsNoCard) {
  const std::string message = opening_error("comedi:/dev/comedi99", Errc::device);
  EXPECT_EQ(message,
            "comedi:/dev/comedi99: /dev/comedi99 cannot be opened (No such file or directory); "
            "expected a card such as /dev/comedi0, with its driver attached");
}

TEST(ComediSource, IsNoCardWhatIsAnotherFile) {
  EXPECT_NE(opening_error("comedi:/dev/null", Errc::device).find("cannot be opened"),
            std::string::npos);
}

TEST(ComediSource, RefusesSettingsThatMakeNoSense) {
  for (const char* const query : {"channels=0,x", "channels=1,1", "channels=,", "channels=-1",
                                  "rate=0", "aref=earth", "range=-2", "gain=3"})
    EXPECT_NE(opening_error(std::string("comedi:/dev/comedi0?") + query, Errc::invalid_argument),
              "it opened")
        << query;
}

}  // namespace
}  // namespace proofmass::acquire::comedi_source_test
