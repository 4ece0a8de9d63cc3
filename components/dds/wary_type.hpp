// The generated types, wary: whoever writes on a topic may send anything. Alone they let bytes
// that are no truth value end the program, and make room for as many elements as a message claims
// that it could hold.
#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/exceptions/Exception.h>

#include <cstdint>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "components/dds/bounds.hpp"
#include "components/dds/topics.hpp"

namespace swivel {

// Samples that were refused, by the name of their type. Counted on any thread.
class Refusals {
 public:
  void count(const std::string& type) {
    const std::lock_guard lock(mutex_);
    ++total_;
    ++news_[type];
  }
  std::uint64_t total() const {
    const std::lock_guard lock(mutex_);
    return total_;
  }
  // Since the last time.
  std::map<std::string, std::uint64_t> take_news() {
    const std::lock_guard lock(mutex_);
    return std::exchange(news_, {});
  }

 private:
  mutable std::mutex mutex_;
  std::uint64_t total_ = 0;
  std::map<std::string, std::uint64_t> news_;
};

// The most bytes that a message of ours takes, with room to spare: a scan line of 20000 beams
// has 80 kB, a cloud of mode 7 11 MB. An element may take a hundred times as much in memory as it
// has bytes on the wire.
template <class Message>
inline constexpr std::uint32_t kMostBytes = 1U << 20;
template <>
inline constexpr std::uint32_t kMostBytes<PointCloud2> = kMostBytesOfACloud + (1U << 16);

// Before anything is made room for.
template <class Message>
bool has_plausible_counts(eprosima::fastcdr::Cdr&) {
  return true;
}
template <>
inline bool has_plausible_counts<PointCloud2>(eprosima::fastcdr::Cdr& cdr) {
  constexpr std::uint32_t kMostFields = 64;
  std_msgs::msg::dds_::Header_ header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::uint32_t fields = 0;
  header.deserialize(cdr);
  cdr >> height >> width >> fields;
  return fields <= kMostFields;
}

template <class Message>
class WaryType : public TypeSupportOf<Message>::Type {
  using Generated = typename TypeSupportOf<Message>::Type;
  using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;

 public:
  explicit WaryType(std::shared_ptr<Refusals> refusals) : refusals_(std::move(refusals)) {}

  bool deserialize(Payload* payload, void* message) override {
    try {
      if (is_plausible(*payload) && Generated::deserialize(payload, message)) return true;
    } catch (const eprosima::fastcdr::exception::Exception&) {
      // The generated type lets pass what is not about its length.
    }
    refusals_->count(Generated::getName());
    return false;
  }

 private:
  static bool is_plausible(const Payload& payload) {
    if (payload.length > kMostBytes<Message>) return false;
    using eprosima::fastcdr::Cdr;
    eprosima::fastcdr::FastBuffer bytes(reinterpret_cast<char*>(payload.data), payload.length);
    Cdr cdr(bytes, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
    cdr.read_encapsulation();
    return has_plausible_counts<Message>(cdr);
  }

  std::shared_ptr<Refusals> refusals_;
};

}  // namespace swivel
