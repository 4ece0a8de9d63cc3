// What `swivel keys` makes, looked at with OpenSSL's own program.
#include "components/keys/key_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <ctime>
#include <filesystem>

#include "components/common/program.hpp"
#include "components/common/strict_yaml.hpp"
#include "components/dds/any_topic.hpp"
#include "components/dds/security.hpp"
#include "tests/components/swivel/scratch_folder.hpp"

namespace swivel {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const std::string kSecurity = SWIVEL_CONFIG "/security";

KeyFolderOptions shipped_options() {
  const std::int64_t now_s = std::time(nullptr);
  return {"some_rig",
          content_of(kSecurity + "/governance.xml"),
          load_grants(kSecurity + "/permissions.yaml"),
          {now_s - 60, now_s + 3600},
          {}};
}

bool succeeds(const std::string& command) {
  return std::system((command + " >/dev/null 2>&1").c_str()) == 0;
}

mode_t mode_of(const std::string& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 ? status.st_mode & 07777 : 0;
}

TEST(KeyFolder, IsForItsOwnerAlone) {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("keys");
  const mode_t usual = umask(0);
  make_key_folder(folder, shipped_options());
  umask(usual);
  EXPECT_EQ(mode_of(folder), 0700U);
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    EXPECT_EQ(mode_of(entry.path()), entry.is_directory() ? 0700U : 0600U) << entry.path();
    files += entry.is_regular_file() ? 1 : 0;
  }
  EXPECT_EQ(files, 3 + 3 * static_cast<int>(shipped_options().grants.size()));
}

TEST(KeyFolder, OpenSslFindsItsCertificatesAndSignaturesSound) {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("keys");
  make_key_folder(folder, shipped_options());
  make_key_folder(scratch.file("others"), shipped_options());
  const SecurityFiles files = security_files(folder, "hokuyo_reader");
  const SecurityFiles others = security_files(scratch.file("others"), "hokuyo_reader");
  const std::string verify = "openssl verify -x509_strict -CAfile " + files.authority + " ";
  EXPECT_TRUE(succeeds(verify + files.certificate));
  EXPECT_FALSE(succeeds(verify + others.certificate));
  const std::string document = scratch.file("document");
  const std::string open =
      "openssl smime -verify -text -CAfile " + files.authority + " -out " + document + " -in ";
  EXPECT_TRUE(succeeds(open + files.governance));
  EXPECT_FALSE(succeeds(open + others.permissions));
  ASSERT_TRUE(succeeds(open + files.permissions));
  EXPECT_THAT(content_of(document), HasSubstr("<topic>some_rig/scan_line</topic>"));
  EXPECT_THAT(content_of(document), HasSubstr("<subject_name>CN=hokuyo_reader</subject_name>"));
  // The key is that of the certificate.
  const std::string key = scratch.file("key"), certified = scratch.file("certified");
  ASSERT_TRUE(succeeds("openssl pkey -pubout -in " + files.private_key + " -out " + key));
  ASSERT_TRUE(
      succeeds("openssl x509 -noout -pubkey -in " + files.certificate + " -out " + certified));
  EXPECT_EQ(content_of(key), content_of(certified));
}

TEST(KeyFolder, OfAKnownAuthorityGoesWithItsOtherFolders) {
  const ScratchFolder scratch;
  make_key_folder(scratch.file("first"), shipped_options());
  KeyFolderOptions again = shipped_options();
  again.authority = load_authority(scratch.file("first"));
  make_key_folder(scratch.file("second"), again);
  const SecurityFiles first = security_files(scratch.file("first"), "swivel_scan");
  const SecurityFiles second = security_files(scratch.file("second"), "swivel_scan");
  EXPECT_EQ(content_of(first.authority), content_of(second.authority));
  EXPECT_NE(content_of(first.private_key), content_of(second.private_key));
  EXPECT_TRUE(succeeds("openssl verify -CAfile " + first.authority + " " + second.certificate));
}

TEST(KeyFolder, NothingIsOverwrittenAndNothingHalfIsLeft) {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("keys");
  make_key_folder(folder, shipped_options());
  const std::string key = content_of(security_files(folder, "cloud_assembler").private_key);
  EXPECT_THROW(make_key_folder(folder, shipped_options()), ExitError);
  EXPECT_EQ(content_of(security_files(folder, "cloud_assembler").private_key), key);
  EXPECT_THROW(make_key_folder(scratch.file("no/such/folder"), shipped_options()), ExitError);
  EXPECT_THROW(load_authority(scratch.file("no")), ExitError);
  const auto left = fs::directory_iterator(scratch.path());
  EXPECT_EQ(std::distance(begin(left), end(left)), 1);
}

TEST(Permissions, ATopicThatIsNoneOrANameThatIsNoNameIsRefused) {
  const ScratchFolder scratch;
  const auto load = [&](const std::string& text) {
    std::ofstream(scratch.file("permissions.yaml")) << text;
    return load_grants(scratch.file("permissions.yaml"));
  };
  EXPECT_EQ(load("viewer: {writes: [], reads: [cloud]}").front().reads.front(), "cloud");
  for (const char* wrong :
       {"viewer: {writes: [], reads: [clouds]}", "viewer: {writes: []}", "viewer: {reads: cloud}",
        "../viewer: {writes: [], reads: []}", "viewer: {writes: [[cloud]], reads: []}",
        "viewer: {writes: [], reads: [], owns: [cloud]}"}) {
    EXPECT_THROW(load(wrong), ConfigurationError) << wrong;
  }
}

// Each topic comes from somebody, and goes to somebody.
TEST(Permissions, AsShippedCoverEveryTopic) {
  for (const AnyTopic& topic : all_topics()) {
    int writers = 0;
    int readers = 0;
    for (const Grant& grant : load_grants(kSecurity + "/permissions.yaml")) {
      writers += std::count(grant.writes.begin(), grant.writes.end(), topic.name);
      readers += std::count(grant.reads.begin(), grant.reads.end(), topic.name);
    }
    EXPECT_GT(writers, 1) << topic.name;  // replay is one
    EXPECT_GT(readers, 1) << topic.name;  // record is one
  }
}

TEST(Keys, ThatAreMissingOrThatEverybodyMayReadAreSaid) {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("keys");
  make_key_folder(folder, shipped_options());
  const auto said = [&](const std::string& name) {
    ParticipantOptions options;
    options.name = name;
    options.security_folder = folder;
    eprosima::fastdds::dds::DomainParticipantQos qos;
    try {
      set_security(options, qos);
    } catch (const DdsError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(said("swivel_scan"), "");
  EXPECT_THAT(said("nobody"), HasSubstr("nobody/certificate.pem"));
  fs::permissions(security_files(folder, "swivel_scan").private_key, fs::perms::others_read,
                  fs::perm_options::add);
  EXPECT_THAT(said("swivel_scan"), HasSubstr("chmod 600"));
}

}  // namespace
}  // namespace swivel
