// Prints every scan line and every corrected cloud of a rig named swivel, and what it missed; ends
// after CLOUDS clouds. Made of Swivel's IDL and Cyclone DDS.
//   CYCLONEDDS_URI=file://$PWD/loopback.xml cyclone_dds_subscriber CLOUDS [DOMAIN]
#include <dds/dds.h>
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "point_cloud2.h"
#include "swivel.h"

static const uint32_t kChecksumStart = 2166136261u;
enum { kHistory = 400 };  // ten seconds of lines, as Swivel keeps them for who joins late

// FNV-1a.
static uint32_t checksum(const void* data, size_t size, uint32_t sum) {
  const uint8_t* bytes = data;
  for (size_t i = 0; i < size; ++i) sum = (sum ^ bytes[i]) * 16777619u;
  return sum;
}

static void must(dds_return_t code, const char* what) {
  if (code >= 0) return;
  fprintf(stderr, "cyclone_dds_subscriber: %s: %s\n", what, dds_strretcode(code));
  exit(69);
}

static dds_entity_t make_reader(dds_entity_t participant, const dds_topic_descriptor_t* type,
                                const char* name, int depth) {
  const dds_entity_t topic = dds_create_topic(participant, type, name, NULL, NULL);
  must(topic, name);
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(5));
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, depth);
  const dds_entity_t reader = dds_create_reader(participant, topic, qos, NULL);
  must(reader, name);
  dds_delete_qos(qos);
  return reader;
}

struct Taken {
  uint64_t lines;
  uint64_t lines_missing;
  uint64_t last_number;
  int clouds;
};

static void show_line(const swivel_msg_ScanLine* line, struct Taken* taken) {
  // Numbers run from 1 and start anew with the reader's process: a hole is a loss.
  const uint64_t number = line->sequence_number;
  if (taken->last_number != 0 && number > taken->last_number)
    taken->lines_missing += number - taken->last_number - 1;
  taken->last_number = number;
  ++taken->lines;
  uint32_t sum = checksum(line->ranges_mm._buffer, 2 * line->ranges_mm._length, kChecksumStart);
  sum = checksum(line->intensities._buffer, 2 * line->intensities._length, sum);
  printf("scan_line %" PRIu64 " at %" PRId64 ": %u ranges, %u intensities, %08x\n", number,
         line->beam0_time_ns, line->ranges_mm._length, line->intensities._length, sum);
}

static void show_cloud(const sensor_msgs_msg_dds__PointCloud2_* cloud) {
  printf("cloud of %d.%09u in %s: %u x %u, %u bytes, %08x\n", cloud->header.stamp.sec,
         cloud->header.stamp.nanosec, cloud->header.frame_id, cloud->height, cloud->width,
         cloud->data._length, checksum(cloud->data._buffer, cloud->data._length, kChecksumStart));
}

static void take_lines(dds_entity_t reader, struct Taken* taken) {
  void* sample = NULL;  // lent by the reader
  dds_sample_info_t info;
  while (dds_take(reader, &sample, &info, 1, 1) > 0) {
    if (info.valid_data) show_line(sample, taken);
    dds_return_loan(reader, &sample, 1);
  }
}

static void take_clouds(dds_entity_t reader, int wanted, struct Taken* taken) {
  void* sample = NULL;
  dds_sample_info_t info;
  while (taken->clouds < wanted && dds_take(reader, &sample, &info, 1, 1) > 0) {
    if (info.valid_data) {
      ++taken->clouds;
      show_cloud(sample);
    }
    dds_return_loan(reader, &sample, 1);
  }
}

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    fprintf(stderr, "usage: cyclone_dds_subscriber CLOUDS [DOMAIN]\n");
    return 64;
  }
  const int wanted = atoi(argv[1]);
  const dds_domainid_t domain = argc == 3 ? (dds_domainid_t)atoi(argv[2]) : 0;
  const dds_entity_t participant = dds_create_participant(domain, NULL, NULL);
  must(participant, "no participant");
  const dds_entity_t lines =
      make_reader(participant, &swivel_msg_ScanLine_desc, "swivel/scan_line", kHistory);
  const dds_entity_t clouds =
      make_reader(participant, &sensor_msgs_msg_dds__PointCloud2__desc, "rt/swivel/cloud", 2);
  const dds_entity_t wait_set = dds_create_waitset(participant);
  for (int i = 0; i < 2; ++i) {
    const dds_entity_t news = dds_create_readcondition(i == 0 ? lines : clouds, DDS_ANY_STATE);
    must(dds_waitset_attach(wait_set, news, 0), "no wait set");
  }
  struct Taken taken = {0};
  while (taken.clouds < wanted) {
    dds_waitset_wait(wait_set, NULL, 0, DDS_INFINITY);
    // Clouds first: what was sent before the last cloud is then among the lines.
    take_clouds(clouds, wanted, &taken);
    take_lines(lines, &taken);
  }
  printf("%" PRIu64 " scan lines, %" PRIu64 " missing; %d clouds\n", taken.lines,
         taken.lines_missing, taken.clouds);
  dds_delete(participant);
  return 0;
}
