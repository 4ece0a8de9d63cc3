// An authority, those that it vouches for, and what it signs; all of it as text, nothing on the
// disk. Throws std::runtime_error where OpenSSL fails.
#pragma once

#include <openssl/types.h>

#include <cstdint>
#include <memory>
#include <string>

namespace swivel {

struct ValidFor {
  std::int64_t from_s = 0;  // since 1970
  std::int64_t to_s = 0;
};

// Both as PEM.
struct Identity {
  std::string certificate;
  std::string private_key;
};

class Authority {
 public:
  Authority(const std::string& common_name, ValidFor validity);
  explicit Authority(const Identity& known);
  ~Authority();
  Authority(const Authority&) = delete;
  Authority& operator=(const Authority&) = delete;

  Identity identity() const;  // its own
  Identity vouch_for(const std::string& common_name, ValidFor validity) const;
  // S/MIME: the text in the clear, and the signature below it.
  std::string sign(const std::string& text) const;

 private:
  struct Keys;
  std::unique_ptr<Keys> keys_;
};

}  // namespace swivel
