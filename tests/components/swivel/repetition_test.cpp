// A recording of one sweep that is played again and again gives a cloud each time.
#include "components/swivel/recorder/repetition.hpp"

#include <gtest/gtest.h>

#include "components/cloud_assembler/assembler.hpp"
#include "components/common/program.hpp"
#include "components/recording/recording.hpp"

namespace swivel {
namespace {

// The messages of the first sweep.
std::vector<ReplayMessage> one_sweep() {
  const ReplaySource source =
      play_case(*Recording::open(std::string(SWIVEL_TEST_DATA) + "/recordings/plate_period"));
  std::vector<ReplayMessage> messages;
  for (auto message = source(); message && message->has_value(); message = source()) {
    messages.push_back(**message);
    if (!messages.back().topic->is(kSweepTopic)) continue;
    if (decode_cdr<msg::Sweep>(messages.back().cdr)->phase() == msg::PHASE_IDLE) break;
  }
  return messages;
}

void give(const ReplayMessage& message, Assembler& assembler) {
  if (message.topic->is(kScanLineTopic)) assembler.add(*decode_cdr<msg::ScanLine>(message.cdr));
  if (message.topic->is(kAxisTopic)) assembler.add(*decode_cdr<msg::Axis>(message.cdr));
  if (message.topic->is(kSweepTopic)) assembler.add(*decode_cdr<msg::Sweep>(message.cdr));
}

TEST(Repetition, OfOneSweepGivesItsCloudInEveryRound) {
  const RigFile rig = load_rig_file(SWIVEL_CONFIG "/rigs/yuan.yaml");
  std::vector<AssembledSweep> assembled;
  Assembler assembler({rig.geometry, rig.axis_measured, rig.timing, M_PI},
                      [&](AssembledSweep&& sweep) { assembled.push_back(std::move(sweep)); });
  Repetition repetition;
  for (int round = 0; round < 3; ++round) {
    repetition.begin_round();
    for (const ReplayMessage& message : one_sweep()) give(repetition.next(message), assembler);
  }
  ASSERT_EQ(assembled.size(), 3U);
  for (std::size_t round = 0; round < 3; ++round) {
    EXPECT_TRUE(assembled[round].sweep.complete()) << assembled[round].sweep.reason();
    ASSERT_EQ(assembled[round].cloud.points.size(), assembled[0].cloud.points.size());
    for (std::size_t point = 0; point < assembled[0].cloud.points.size(); ++point) {
      const CloudPoint& first = assembled[0].cloud.points[point];
      const CloudPoint& again = assembled[round].cloud.points[point];
      ASSERT_EQ(again.valid(), first.valid());
      if (!first.valid()) continue;
      ASSERT_EQ(again.x_m, first.x_m);
    }
    if (round == 0) continue;
    const msg::Sweep& before = assembled[round - 1].sweep;
    EXPECT_GT(assembled[round].sweep.sweep_id(), before.sweep_id());
    EXPECT_GT(assembled[round].sweep.first_beam_time_ns(), before.window_end_ns());
  }
}

}  // namespace
}  // namespace swivel
