// Who may look. A browser tells where a page came from (Origin) and whom it meant (Host): a page
// of somebody else must not start the motor, nor one that made its name point to this computer.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace swivel {

struct AccessPolicy {
  std::string token;                         // asked of everybody; empty: of nobody
  std::vector<std::string> allowed_origins;  // besides the gateway's own page
};

// What a request says of itself; empty where it says nothing.
struct AccessClaims {
  std::string host;    // the header, with its port
  std::string origin;  // the header; only browsers send it
  std::string token;   // ?token=... or Authorization: Bearer ...
};

struct Refusal {
  int status = 403;  // of HTTP
  std::string reason;
};

// None for who is welcome.
std::optional<Refusal> refusal(const AccessPolicy& policy, const AccessClaims& claims);

// From the request's target and its Authorization header.
std::string token_in(const std::string& target, const std::string& authorization);

// The time that it takes tells nothing of where they differ.
bool equal_in_constant_time(const std::string& given, const std::string& expected);

// A token can stand in an address as it is, and is too long to be guessed.
bool is_token(const std::string& text);
std::string new_token();

// For its owner alone (mode 0600), whatever was there before. Empty, or what went wrong.
[[nodiscard]] std::string write_token(const std::string& token, const std::string& path);

}  // namespace swivel
