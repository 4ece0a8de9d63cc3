// libFuzzer's entry into the target of --target=NAME.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "tests/fuzz/targets.hpp"

namespace {

using swivel::fuzz::Target;

const Target* chosen = nullptr;

const Target* target_named(std::string_view name) {
  for (const Target& target : swivel::fuzz::kTargets) {
    if (target.name == name) return &target;
  }
  return nullptr;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  constexpr std::string_view kOption = "--target=";  // libFuzzer passes over what begins with --
  for (int index = 1; index < *count; ++index) {
    const std::string_view argument = (*arguments)[index];
    if (argument.substr(0, kOption.size()) == kOption)
      chosen = target_named(argument.substr(kOption.size()));
  }
  if (chosen != nullptr) return 0;
  std::fputs("swivel_fuzz: name one with --target=:", stderr);
  for (const Target& target : swivel::fuzz::kTargets)
    std::fprintf(stderr, " %.*s", static_cast<int>(target.name.size()), target.name.data());
  std::fputs("\n", stderr);
  std::exit(64);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  chosen->run({reinterpret_cast<const char*>(data), size});
  return 0;
}
