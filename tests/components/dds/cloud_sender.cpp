// For participant_test: publishes clouds of 11 MB from a process of its own as soon as
// there is a reader, and stays until its standard input is closed. Usage: cloud_sender DOMAIN COUNT
// PROFILES
#include <iostream>
#include <string>

#include "components/dds/participant.hpp"
#include "tests/components/dds/test_participant.hpp"

int main(int argc, char** argv) {
  using namespace swivel;
  if (argc != 4) return 64;
  Participant participant(loopback_participant("cloud_sender", std::stoi(argv[1]), argv[3]));
  Writer<PointCloud2> clouds(participant, kRawCloudTopic);
  participant.start();
  // Of clouds only the last two are kept for those who come late.
  if (!wait_until([&] { return clouds.reader_count() > 0; })) return 75;
  for (int number = 1; number <= std::stoi(argv[2]); ++number) {
    clouds.write(numbered_cloud(number));
    if (!clouds.wait_until_acknowledged(std::chrono::seconds(20))) return 75;
  }
  std::cin.get();
  return 0;
}
