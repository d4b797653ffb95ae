#include "harness/provenance.h"

#include <gtest/gtest.h>

#include <regex>

namespace liebench {
namespace {

TEST(Provenance, NamesEveryLibraryWithAVersion) {
  const Json origin = provenance();
  for (const char* library : {"eigen", "qd", "boost", "fmt"}) {
    ASSERT_TRUE(origin["libraries"].contains(library)) << library;
    EXPECT_TRUE(
        std::regex_search(origin["libraries"][library].get<std::string>(), std::regex("^[0-9]+\\.[0-9]+")))
        << library << ": " << origin["libraries"][library];
  }
}

TEST(Provenance, SaysWhatWasBuiltAndHow) {
  const BuildInfo build = build_info();
  EXPECT_TRUE(std::regex_match(build.commit, std::regex("[0-9a-f]{40}|unknown"))) << build.commit;
  EXPECT_TRUE(std::regex_match(build.version, std::regex("[0-9]+\\.[0-9]+\\.[0-9]+"))) << build.version;
  EXPECT_FALSE(build.compiler.empty());
  EXPECT_NE(build.flags.find("-ffp-contract=off"), std::string::npos) << "it changes the numbers";
  const Json origin = provenance();
  EXPECT_EQ(origin["commit"], build.commit);
  EXPECT_EQ(origin["dirty"], build.dirty);
  EXPECT_EQ(origin["compiler"], build.compiler);
  EXPECT_EQ(origin["flags"], build.flags);
  EXPECT_FALSE(origin["cpu"].get<std::string>().empty());
}

TEST(Provenance, TheDateIsUtcInIso8601) {
  EXPECT_TRUE(
      std::regex_match(provenance()["date"].get<std::string>(),
                       std::regex("20[0-9]{2}-[01][0-9]-[0-3][0-9]T[0-2][0-9]:[0-5][0-9]:[0-6][0-9]Z")));
}

}  // namespace
}  // namespace liebench
