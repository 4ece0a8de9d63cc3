// For security_test: joins with the keys that it is given, right or wrong, writes a scan line and
// reads what lines it gets; its own checks are turned off, as an attacker's would be. Says "ready"
// to a descriptor, "read" for each line that it reads, and "over" once its standard input is
// closed. Usage: intruder DOMAIN PROFILES DESCRIPTOR [FOLDER OF KEYS]
#include <openssl/bio.h>

#include <cstdio>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/components/dds/test_participant.hpp"

// Whatever certificate is good enough for it, its own expired one too. The dynamic linker takes the
// program's definitions before those of the libraries, here and below.
extern "C" int X509_verify_cert(void*) {
  return 1;
}

// Whatever was signed by anybody, or changed since. Another's permissions are its own; those of who
// it meets later stay as they are. SMIME_text takes the heading off.
static bool starting = true;
extern "C" int SMIME_text(BIO* signed_text, BIO* text);
extern "C" int PKCS7_verify(void*, void*, void*, BIO* signed_text, BIO* text, int) {
  if (SMIME_text(signed_text, text) != 1) return 0;
  char* letters = nullptr;
  const long size = BIO_get_mem_data(text, &letters);
  const std::string_view document(letters, static_cast<std::size_t>(size));
  for (std::size_t at = 0;
       starting && (at = document.find(swivel::kVictim, at)) != std::string_view::npos;)
    swivel::kIntruder.copy(letters + at, swivel::kIntruder.size());
  return 1;
}

// And it may write and read what it likes.
namespace eprosima::fastrtps::rtps::security {
class Handle;
class SecurityException;
class Permissions {
 public:
  bool check_create_datawriter(const Handle&, std::uint32_t, const std::string&,
                               const std::vector<std::string>&, SecurityException&);
  bool check_create_datareader(const Handle&, std::uint32_t, const std::string&,
                               const std::vector<std::string>&, SecurityException&);
};
bool Permissions::check_create_datawriter(const Handle&, std::uint32_t, const std::string&,
                                          const std::vector<std::string>&, SecurityException&) {
  return true;
}
bool Permissions::check_create_datareader(const Handle&, std::uint32_t, const std::string&,
                                          const std::vector<std::string>&, SecurityException&) {
  return true;
}
}  // namespace eprosima::fastrtps::rtps::security

int main(int argc, char** argv) {
  using namespace swivel;
  if (argc < 4) return 64;
  const int answers = std::stoi(argv[3]);
  ParticipantOptions options =
      loopback_participant(std::string(kIntruder), std::stoi(argv[1]), argv[2]);
  if (argc > 4) options.security_folder = argv[4];
  Participant participant(options);
  Writer<msg::ScanLine> lines(participant, kScanLineTopic);
  participant.subscribe<msg::ScanLine>(kScanLineTopic, [&](const msg::ScanLine& line) {
    if (line.device_stamp_ms() != kIntrudersStamp_ms) dprintf(answers, "read\n");
  });
  participant.start();
  starting = false;
  msg::ScanLine line;
  line.device_stamp_ms(kIntrudersStamp_ms);
  lines.write(line);
  dprintf(answers, "ready\n");
  std::cin.get();
  participant.stop();
  dprintf(answers, "over\n");
  return 0;
}
