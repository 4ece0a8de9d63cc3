#include "components/gateway/access_policy.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <random>

namespace swivel {
namespace {

constexpr std::size_t kShortestToken = 16;
constexpr const char* kBearer = "Bearer ";
constexpr const char* kTokenKey = "token=";
constexpr const char* kTokenLetters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

bool starts_with(const std::string& text, const std::string& beginning) {
  return text.compare(0, beginning.size(), beginning) == 0;
}

std::string without_port(const std::string& host) {
  const std::size_t bracket = host.find(']');  // of an IPv6 address
  const std::size_t colon = host.find(':', bracket == std::string::npos ? 0 : bracket);
  return host.substr(0, colon);
}

bool names_this_computer(const std::string& host) {
  const std::string name = without_port(host);
  return name == "localhost" || name == "127.0.0.1" || name == "[::1]";
}

}  // namespace

std::optional<Refusal> refusal(const AccessPolicy& policy, const AccessClaims& claims) {
  if (!policy.token.empty() && !equal_in_constant_time(claims.token, policy.token)) {
    return Refusal{401, "this needs the token: add ?token=... to the address"};
  }
  // Who has the token may call this computer by any name.
  if (policy.token.empty() && !names_this_computer(claims.host)) {
    return Refusal{403, "call this computer localhost"};
  }
  const auto& allowed = policy.allowed_origins;
  const bool own = claims.origin.empty() || claims.origin == "http://" + claims.host;
  if (!own && std::find(allowed.begin(), allowed.end(), claims.origin) == allowed.end()) {
    return Refusal{403, "a page from elsewhere may not; see --allow-origin"};
  }
  return std::nullopt;
}

std::string token_in(const std::string& target, const std::string& authorization) {
  if (starts_with(authorization, kBearer)) return authorization.substr(std::strlen(kBearer));
  std::size_t at = target.find('?');
  while (at != std::string::npos) {
    const std::size_t end = target.find('&', at + 1);
    const std::string part = target.substr(at + 1, end == std::string::npos ? end : end - at - 1);
    if (starts_with(part, kTokenKey)) return part.substr(std::strlen(kTokenKey));
    at = end;
  }
  return {};
}

bool equal_in_constant_time(const std::string& given, const std::string& expected) {
  volatile unsigned difference = given.size() == expected.size() ? 0U : 1U;
  for (std::size_t place = 0; place < given.size(); ++place) {
    const char letter = expected.empty() ? '\0' : expected[place % expected.size()];
    difference = difference | static_cast<unsigned char>(given[place] ^ letter);
  }
  return difference == 0U;
}

bool is_token(const std::string& text) {
  return text.size() >= kShortestToken &&
         text.find_first_not_of(kTokenLetters) == std::string::npos;
}

std::string new_token() {
  std::random_device device;
  std::string token(32, '\0');
  for (char& letter : token) letter = kTokenLetters[device() % std::strlen(kTokenLetters)];
  return token;
}

std::string write_token(const std::string& token, const std::string& path) {
  // Made anew, so that neither a link nor another's open file gets it.
  unlink(path.c_str());
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
  if (file < 0) return path + ": " + std::strerror(errno);
  const std::string line = token + "\n";
  const bool written = write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  const std::string why = written ? "" : path + ": " + std::strerror(errno);
  close(file);
  return why;
}

}  // namespace swivel
