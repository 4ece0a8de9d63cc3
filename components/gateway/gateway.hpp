// Joins a rig's topics to the server: what comes over DDS goes to the pages, what a page asks for
// goes to the sequencer.
#pragma once

#include <atomic>
#include <mutex>
#include <string>

#include "components/common/health_reporter.hpp"
#include "components/common/rig_file.hpp"
#include "components/common/roll.hpp"
#include "components/common/sweep_requester.hpp"
#include "components/gateway/live_view.hpp"
#include "components/gateway/server.hpp"

namespace swivel {

class Gateway {
 public:
  // Subscribes: before participant.start(). Listens at once. Throws ServerError.
  Gateway(Participant& participant, const RigFile& rig, const ServerOptions& options);

  std::uint16_t port() const { return server_.port(); }

 private:
  ServerContent server_content();
  void subscribe(Participant& participant);
  // take is called under the mutex.
  template <class Message, class Take>
  void pass_on(Participant& participant, const Topic<Message>& topic, std::uint32_t channel,
               Take take);
  void take(const msg::Sweep& sweep);
  void take(const PointCloud2& cloud);
  void obey(const std::string& text);
  void tick();
  void repeat_request();
  void publish_state(std::chrono::steady_clock::time_point now);
  void report();

  RigFile rig_;
  HealthReporter health_;
  Roll roll_;
  Writer<msg::SweepRequest> requests_;
  std::atomic<std::int64_t> last_tick_ns_{0};  // of the steady clock

  mutable std::mutex mutex_;  // of what follows: two threads come here
  LiveView view_;
  SweepRequester requester_;
  std::string answer_;
  std::string last_state_;  // without the participants, whose ages change at all times
  std::chrono::steady_clock::time_point state_sent_{};
  std::uint64_t clouds_refused_ = 0;
  std::uint64_t commands_refused_ = 0;

  Server server_;  // last: its thread uses all of the above
};

}  // namespace swivel
