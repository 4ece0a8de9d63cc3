#include "components/gateway/access_policy.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "tests/support/own_path.hpp"

namespace swivel {
namespace {

constexpr const char* kToken = "0123456789abcdefXYZ_-";

int status(const AccessPolicy& policy, const AccessClaims& claims) {
  const auto refused = refusal(policy, claims);
  return refused ? refused->status : 200;
}

TEST(AccessPolicy, OnLoopbackTheOwnPageAndPlainPrograms) {
  const AccessPolicy policy;
  for (const char* host : {"127.0.0.1:8750", "localhost:8750", "[::1]:8750", "localhost"}) {
    EXPECT_EQ(status(policy, {host, "", ""}), 200) << host;
    EXPECT_EQ(status(policy, {host, std::string("http://") + host, ""}), 200) << host;
  }
}

TEST(AccessPolicy, AForeignPageMayNot) {
  const AccessPolicy policy;
  for (const char* origin :
       {"http://evil.example", "http://localhost:1", "null", "https://localhost:8750",
        "http://localhost:8750.evil.example", "http://127.0.0.1:8750"})
    EXPECT_EQ(status(policy, {"localhost:8750", origin, ""}), 403) << origin;
}

// A name that somebody made point to this computer (DNS rebinding).
TEST(AccessPolicy, AForeignNameForThisComputerMayNot) {
  const AccessPolicy policy;
  for (const char* host : {"evil.example:8750", "localhost.evil.example", "127.0.0.1.evil.example",
                           "[::1].evil.example", "", "127.0.0.2"})
    EXPECT_EQ(status(policy, {host, std::string("http://") + host, ""}), 403) << host;
}

TEST(AccessPolicy, AnAllowedOriginMay) {
  const AccessPolicy policy{"", {"https://app.foxglove.dev"}};
  EXPECT_EQ(status(policy, {"localhost:8750", "https://app.foxglove.dev", ""}), 200);
  EXPECT_EQ(status(policy, {"localhost:8750", "https://app.foxglove.dev.evil", ""}), 403);
}

TEST(AccessPolicy, WithATokenNobodyWithoutIt) {
  const AccessPolicy policy{kToken, {}};
  const std::string robot = "192.168.0.7:8750";
  EXPECT_EQ(status(policy, {robot, "", ""}), 401);
  EXPECT_EQ(status(policy, {"localhost:8750", "", ""}), 401);
  EXPECT_EQ(status(policy, {robot, "", std::string(kToken) + "x"}), 401);
  EXPECT_EQ(status(policy, {robot, "", std::string(kToken) + kToken}), 401);
  EXPECT_EQ(status(policy, {robot, "", std::string(kToken).substr(1)}), 401);
  EXPECT_EQ(status(policy, {robot, "", kToken}), 200);
  EXPECT_EQ(status(policy, {robot, "http://" + robot, kToken}), 200);
  EXPECT_EQ(status(policy, {robot, "http://evil.example", kToken}), 403);
}

TEST(AccessPolicy, TheTokenStandsInTheAddressOrTheHeader) {
  EXPECT_EQ(token_in("/live?token=abc", ""), "abc");
  EXPECT_EQ(token_in("/live?a=b&token=abc&c=d", ""), "abc");
  EXPECT_EQ(token_in("/metrics", "Bearer abc"), "abc");
  for (const char* target :
       {"/", "/?", "/?&", "/?token", "/token=abc", "/?mytoken=abc", "/?token="})
    EXPECT_EQ(token_in(target, ""), "") << target;
  EXPECT_EQ(token_in("/", "Basic abc"), "");
}

TEST(AccessPolicy, NewTokensAreTokensAndUnlike) {
  const std::string token = new_token();
  EXPECT_TRUE(is_token(token));
  EXPECT_GE(token.size(), 32U);
  EXPECT_NE(token, new_token());
  for (const char* bad : {"", "short", "0123456789abcde ", "0123456789abcdef&x"})
    EXPECT_FALSE(is_token(bad)) << bad;
}

TEST(AccessPolicy, ATokensFileIsItsOwnersAloneEvenOverALink) {
  const std::string target = own_path("linked_to");
  const std::string path = own_path("token");
  std::ofstream(target) << "mine\n";
  ASSERT_EQ(symlink(target.c_str(), path.c_str()), 0);
  ASSERT_EQ(write_token(kToken, path), "");
  struct stat about {};
  ASSERT_EQ(lstat(path.c_str(), &about), 0);
  EXPECT_TRUE(S_ISREG(about.st_mode));
  EXPECT_EQ(about.st_mode & 0777U, 0600U);
  std::string line;
  std::getline(std::ifstream(path) >> std::ws, line);
  EXPECT_EQ(line, kToken);
  std::getline(std::ifstream(target) >> std::ws, line);
  EXPECT_EQ(line, "mine");
  EXPECT_THAT(write_token(kToken, "/nowhere/token"), testing::HasSubstr("/nowhere"));
}

}  // namespace
}  // namespace swivel
