// What is written is read again; what is cut or damaged is left out, and never delivered changed.
// That the bytes are MCAP is for the readers of others to say: tests/components/swivel/foreign.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <tuple>
#include <vector>

#include "components/mcap/reader.hpp"
#include "components/mcap/writer.hpp"
#include "tests/support/own_path.hpp"

namespace swivel {
namespace {

using testing::HasSubstr;

// A message with all that its channel says of it.
struct Told {
  std::string topic;
  std::string schema;
  std::uint32_t sequence;
  std::int64_t log_time_ns;
  std::int64_t publish_time_ns;
  std::string data;

  bool operator==(const Told& other) const {
    return std::tie(topic, schema, sequence, log_time_ns, publish_time_ns, data) ==
           std::tie(other.topic, other.schema, other.sequence, other.log_time_ns,
                    other.publish_time_ns, other.data);
  }
};

struct ReadBack {
  std::vector<Told> messages;
  McapDamage damage;
};

ReadBack read_all(const std::string& path) {
  ReadBack back;
  auto reader = McapReader::open(path);
  if (!reader) return back;
  while (const auto message = reader->next()) {
    const McapChannel& channel = reader->channel(message->channel_id);
    back.messages.push_back({channel.topic, channel.schema.definition, message->sequence,
                             message->log_time_ns, message->publish_time_ns,
                             std::string(message->data)});
  }
  back.damage = reader->damage();
  return back;
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

// A recording of a few kilobytes: three channels on two topics, chunks of one to five messages.
class McapFile : public testing::Test {
 protected:
  McapFile() {
    std::filesystem::remove(path_);
    auto writer = McapWriter::create(path_);
    EXPECT_TRUE(writer) << writer.reason();
    std::vector<McapChannel> channels{{"rig/line", "cdr", {"Line", "omgidl", "struct Line"}, {}},
                                      {"rt/cloud", "cdr", {"Cloud", "ros2msg", "uint8[] data"}, {}},
                                      {"rig/line", "cdr", {"Line", "omgidl", "struct Line"}, {}}};
    for (const McapChannel& channel : channels) ids_.push_back(*writer->add_channel(channel));
    for (int chunk = 0; chunk < 12; ++chunk) {
      for (int i = 0; i <= chunk % 5; ++i) write_one(*writer, channels);
      EXPECT_TRUE(writer->end_chunk());
      chunk_ends_.push_back({writer->size_bytes(), written_.size()});
    }
    EXPECT_TRUE(writer->close());
    bytes_ = bytes_of(path_);
  }
  ~McapFile() override { std::filesystem::remove(path_); }

  void write_one(McapWriter& writer, const std::vector<McapChannel>& channels) {
    const auto count = static_cast<std::uint32_t>(written_.size());
    // The first two chunks have all channels, and so their definitions.
    const std::size_t channel = count < ids_.size() ? count : random_() % ids_.size();
    // Bytes of a chunk's head among them, to be taken for one.
    std::string data(random_() % 60, '\x06');
    for (char& byte : data) byte = random_() % 3 == 0 ? '\x06' : static_cast<char>(random_());
    written_.push_back({channels[channel].topic, channels[channel].schema.definition, count,
                        1000 + count, 900 + count, data});
    EXPECT_TRUE(writer.write({ids_[channel], count, 1000 + count, 900 + count, data}));
  }

  // Reads the file with some bytes in place of its own, which come back.
  ReadBack read_with(std::size_t at, const std::string& bytes) const {
    const auto overwrite = [&](const std::string& some) {
      std::fstream file(path_, std::ios::binary | std::ios::in | std::ios::out);
      file.seekp(static_cast<std::streamoff>(at));
      file << some;
    };
    overwrite(bytes);
    ReadBack back = read_all(path_);
    overwrite(bytes_.substr(at, bytes.size()));
    return back;
  }

  // Whether `some` are of those written, in their order and unchanged.
  bool is_part(const std::vector<Told>& some) const {
    auto at = written_.begin();
    for (const Told& one : some) {
      at = std::find(at, written_.end(), one);
      if (at == written_.end()) return false;
      ++at;
    }
    return true;
  }

  struct ChunkEnd {
    std::uint64_t byte;  // with its indexes
    std::size_t messages;
  };

  const std::string path_ = own_path("recording.mcap");
  std::mt19937 random_{7};
  std::vector<std::uint16_t> ids_;
  std::vector<Told> written_;
  std::vector<ChunkEnd> chunk_ends_;
  std::string bytes_;
};

TEST_F(McapFile, GivesBackWhatWasWritten) {
  const ReadBack back = read_all(path_);
  EXPECT_TRUE(back.messages == written_);
  EXPECT_TRUE(back.damage.none());
  EXPECT_FALSE(std::filesystem::exists(path_ + ".part"));
}

TEST_F(McapFile, CutAnywhereGivesItsWholeChunks) {
  for (std::size_t length = bytes_.size() - 1; length >= kMcapMagic.size(); --length) {
    std::filesystem::resize_file(path_, length);
    const ReadBack back = read_all(path_);
    std::size_t at_least = 0;
    std::size_t at_most = 0;
    for (const ChunkEnd& chunk : chunk_ends_) {
      if (chunk.byte <= length) at_least = chunk.messages;
    }
    for (const ChunkEnd& chunk : chunk_ends_) {
      at_most = chunk.messages;
      if (chunk.byte > length) break;
    }
    ASSERT_GE(back.messages.size(), at_least) << length;
    ASSERT_LE(back.messages.size(), at_most) << length;
    ASSERT_TRUE(std::equal(back.messages.begin(), back.messages.end(), written_.begin())) << length;
    ASSERT_FALSE(back.damage.none()) << length;
  }
}

TEST_F(McapFile, AFlippedBitTakesAtMostItsChunkAndIsNeverDelivered) {
  std::size_t largest_loss = 0;
  for (std::size_t at = kMcapMagic.size(); at < bytes_.size(); ++at) {
    const auto flipped = static_cast<char>(bytes_[at] ^ (1 << (random_() % 8)));
    const ReadBack back = read_with(at, {flipped});
    ASSERT_TRUE(is_part(back.messages)) << "delivered what was not written; byte " << at;
    const std::size_t lost = written_.size() - back.messages.size();
    if (lost > 0) {
      ASSERT_FALSE(back.damage.none()) << "lost without a word; byte " << at;
    }
    if (at > chunk_ends_[1].byte) largest_loss = std::max(largest_loss, lost);
  }
  EXPECT_LE(largest_loss, 5U) << "the chunks have at most five messages";
}

TEST_F(McapFile, GarbageInPlaceOfNumbersNeitherHangsNorIsDelivered) {
  const std::array<std::string, 4> absurd{std::string(8, '\xFF'), std::string(7, '\0') + "\x40",
                                          std::string(8, '\0'), std::string(4, '\xFF')};
  for (std::size_t at = kMcapMagic.size(); at + 8 < bytes_.size(); ++at) {
    ASSERT_TRUE(is_part(read_with(at, absurd[at % absurd.size()]).messages)) << at;
  }
}

TEST_F(McapFile, AHoleBetweenChunksIsJumped) {
  const std::size_t start = chunk_ends_[4].byte + 3;
  const std::size_t end = chunk_ends_[9].byte - 5;
  const ReadBack back = read_with(start, std::string(end - start, '\0'));
  const std::size_t lost = chunk_ends_[9].messages - chunk_ends_[4].messages;
  EXPECT_EQ(back.messages.size(), written_.size() - lost);
  EXPECT_TRUE(is_part(back.messages));
  EXPECT_GT(back.damage.skipped_bytes, 0U);
}

TEST_F(McapFile, NeitherAFileNorAPartOfOneIsWrittenOver) {
  EXPECT_THAT(McapWriter::create(path_).reason(), HasSubstr("already there"));
  std::filesystem::rename(path_, path_ + ".part");
  EXPECT_THAT(McapWriter::create(path_).reason(), HasSubstr(".part is already there"));
  std::filesystem::remove(path_ + ".part");
}

// Four bytes that turn the CRC of `bytes` followed by them into 0. What four bytes do to a CRC is
// linear, so that each bit of them is found by elimination.
std::string bytes_for_no_crc(const std::string& bytes) {
  const auto crc_with = [&](std::uint32_t tail) {
    std::string all = bytes;
    for (int byte = 0; byte < 4; ++byte) all.push_back(static_cast<char>(tail >> (8 * byte)));
    return static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(all.data()), static_cast<uInt>(all.size())));
  };
  const std::uint32_t base = crc_with(0);
  std::array<std::pair<std::uint32_t, std::uint32_t>, 32> effects{};  // by highest bit of the first
  for (std::uint32_t bit = 0; bit < 32; ++bit) {
    std::pair<std::uint32_t, std::uint32_t> effect{crc_with(1U << bit) ^ base, 1U << bit};
    for (std::size_t high = 32; high-- > 0;) {
      if ((effect.first >> high & 1U) == 0) continue;
      if (effects[high].first == 0) {
        effects[high] = effect;
        break;
      }
      effect.first ^= effects[high].first;
      effect.second ^= effects[high].second;
    }
  }
  std::uint32_t left = base;
  std::uint32_t tail = 0;
  for (std::size_t high = 32; high-- > 0;) {
    if ((left >> high & 1U) == 0) continue;
    left ^= effects[high].first;
    tail ^= effects[high].second;
  }
  EXPECT_EQ(crc_with(tail), 0U);
  std::string found;
  for (int byte = 0; byte < 4; ++byte) found.push_back(static_cast<char>(tail >> (8 * byte)));
  return found;
}

// A sum of 0 stands for "no sum", and such a chunk is not delivered.
TEST(McapWriter, NeverWritesASumOfNought) {
  const std::string path = own_path("nought.mcap");
  const auto write = [&](const std::string& data) {
    std::filesystem::remove(path);
    auto writer = McapWriter::create(path);
    const auto id = writer->add_channel({"topic", "cdr", {"Type", "omgidl", "struct"}, {}});
    EXPECT_TRUE(writer->write({*id, 1, 2, 3, data}));
    EXPECT_TRUE(writer->close());
  };
  write("0000");
  const std::string bytes = bytes_of(path);
  const std::size_t records = bytes.find("\x03", kMcapMagic.size() + 9 + 4 + 10 + 9 + 40);
  const std::size_t data = bytes.find("0000");
  write(bytes_for_no_crc(bytes.substr(records, data - records)));
  const ReadBack back = read_all(path);
  EXPECT_EQ(back.messages.size(), 1U);
  EXPECT_TRUE(back.damage.none());
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace swivel
