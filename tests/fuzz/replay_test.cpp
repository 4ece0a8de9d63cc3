// What the fuzzers begin with, and all that they ever found, once more: in every build, and so
// under its sanitizers.
#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>

#include "tests/components/swivel/scratch_folder.hpp"
#include "tests/fuzz/targets.hpp"

namespace swivel::fuzz {

void PrintTo(const Target& target, std::ostream* out) {  // NOLINT: gtest's name
  *out << target.name;
}

namespace {

class Replay : public ::testing::TestWithParam<Target> {};

TEST_P(Replay, OfTheCorpus) {
  const std::string folder = std::string(SWIVEL_TEST_DATA "/fuzz/") + std::string(GetParam().name);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string bytes = content_of(entry.path());
    SCOPED_TRACE(entry.path().string());
    GetParam().run(bytes);
    for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 50)
      GetParam().run(std::string_view(bytes).substr(0, size));  // cut
    ++files;
  }
  EXPECT_GE(files, 3) << folder;
}

INSTANTIATE_TEST_SUITE_P(Targets, Replay, ::testing::ValuesIn(kTargets),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace swivel::fuzz
