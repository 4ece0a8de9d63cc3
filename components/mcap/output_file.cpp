#include "components/mcap/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "components/mcap/bytes.hpp"

namespace swivel {
namespace {

// So that the new name, too, outlives a power cut.
void sync_folder_of(const std::string& name) {
  const std::string folder = std::filesystem::path(name).parent_path();
  const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

}  // namespace

std::string part_of(const std::string& name) {
  return name + ".part";
}

Result<OutputFile> OutputFile::create(const std::string& name) {
  for (const std::string& taken : {name, part_of(name)}) {
    std::error_code error;
    if (std::filesystem::exists(taken, error)) {
      return Failure{taken + " is already there; choose another name, or move it away"};
    }
  }
  const int descriptor = open(part_of(name).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  OutputFile file(name, descriptor);
  if (descriptor < 0) return file.failure("cannot be made");
  sync_folder_of(name);
  return file;
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : name_(std::move(other.name_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_),
      crc_(other.crc_) {}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

Outcome OutputFile::append(std::string_view bytes) {
  if (broken_) return Failure{part_of(name_) + " has a hole, since a write failed"};
  crc_ = mcap_crc(bytes, crc_);
  size_ += bytes.size();
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      broken_ = true;
      return failure("cannot be written");
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return Done{};
}

Outcome OutputFile::sync() {
  if (fdatasync(descriptor_) != 0) return failure("cannot be brought to the disk");
  return Done{};
}

Outcome OutputFile::finish() {
  if (const Outcome synced = sync(); !synced) return Failure{synced.reason()};
  if (close(std::exchange(descriptor_, -1)) != 0) return failure("cannot be closed");
  if (rename(part_of(name_).c_str(), name_.c_str()) != 0) return failure("cannot be renamed");
  sync_folder_of(name_);
  return Done{};
}

Failure OutputFile::failure(const std::string& what) const {
  return Failure{part_of(name_) + " " + what + ": " + std::strerror(errno)};
}

}  // namespace swivel
