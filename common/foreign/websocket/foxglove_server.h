#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "voxlist/foreign/foxglove/audience.h"

namespace voxlist::foreign {

/// The names under which Foxglove's and Lichtblick's clients ask for this protocol; they mean the
/// same.
inline constexpr std::array<std::string_view, 2> kFoxgloveProtocols{"foxglove.sdk.v1",
                                                                    "foxglove.websocket.v1"};

/// One WebSocket message to a client.
struct ClientFrame {
  bool is_text = false;
  std::string bytes;
};

/// Foxglove's WebSocket protocol, without the sockets: whoever has those tells it what a client
/// says, and asks for what is next when a client can take it. It offers channels and the time;
/// nothing that a client says changes anything but its own subscriptions. Compatible as of November
/// 2026 (npm's @foxglove/ws-protocol 0.8).
///
/// A slow client misses messages, the oldest first: of each channel kWaitingBytes wait for it, or
/// the newest message alone. Clients share what waits.
class FoxgloveServer : public Audience {
 public:
  /// Topics that are known at most: their names come from messages.
  static constexpr std::size_t kMostTopics = 200;
  /// Most bytes of one channel that wait for one client.
  static constexpr std::size_t kWaitingBytes = 65'536;
  /// Answers that wait for one client; more are not given.
  static constexpr std::size_t kMostAnswers = 100;

  /// `session`: another one each time the program starts, so that clients drop what they had.
  FoxgloveServer(std::string name, std::string session);

  /// A client comes, and has this number until it goes.
  int open();
  void close(int client);

  /// What a client says. Any text is safe; what means nothing is answered with a warning.
  void on_text(int client, std::string_view text);
  void on_binary(int client, std::string_view bytes);

  /// The next message for a client; nothing: it has all.
  std::optional<ClientFrame> next(int client);

  bool wants(const Topic& topic) override;
  void tell(const Topic& topic, std::int64_t utime_us, std::string bytes) override;

  /// The time of the robot's data, for whatever else a client shows.
  void tell_time(std::int64_t utime_us);

 private:
  using Number = std::uint32_t;

  struct Message {
    std::int64_t utime_us;
    std::string bytes;
  };
  using Shared = std::shared_ptr<const Message>;

  struct Subscription {
    std::size_t topic = 0;
    std::deque<Shared> waiting;
    std::size_t bytes = 0;

    void add(const Shared& message);
    Shared take();
  };

  struct Client {
    std::deque<std::string> answers;
    std::size_t advertised = 0;  // topics that it knows
    std::map<Number, Subscription> subscriptions;
    Number served = 0;  // whose turn was last
    std::optional<std::int64_t> time_us;
  };

  std::optional<std::size_t> topic_number(const Topic& topic);
  std::string advertisement(std::size_t first) const;
  void subscribe(Client& client, std::uint64_t number, std::uint64_t topic);
  void unsubscribe(Client& client, std::uint64_t number);
  static void warn(Client& client, const std::string& sentence);
  static std::optional<ClientFrame> next_message(Client& client);

  const std::string name_, session_;
  std::vector<Topic> topics_;
  std::vector<Shared> newest_;  // of each topic
  std::map<int, Client> clients_;
  int next_client_ = 1;
};

}  // namespace voxlist::foreign
