#include "voxlist/foreign/websocket/foxglove_server.h"

#include <algorithm>
#include <concepts>
#include <nlohmann/json.hpp>
#include <utility>

#include "voxlist/foreign/websocket/base64.h"

namespace voxlist::foreign {
namespace {

using nlohmann::json;

// What a binary message to a client is: its first byte.
constexpr char kMessageData = 1, kTime = 2;

// How bad a status is.
constexpr int kWarning = 1;

template <std::unsigned_integral T>
void put(T value, std::string& to) {
  for (std::size_t i = 0; i < sizeof(T); ++i) to += static_cast<char>(value >> (8 * i) & 0xFF);
}

std::uint64_t ns(std::int64_t us) { return static_cast<std::uint64_t>(us) * 1000; }

std::string text_of(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

// A number in an object; nothing where there is none.
std::optional<std::uint64_t> number_in(const json& object, const char* key) {
  if (!object.is_object()) return std::nullopt;
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number_unsigned()) return std::nullopt;
  return found->get<std::uint64_t>();
}

// An array in an object; empty where there is none.
json array_in(const json& object, const char* key) {
  const auto found = object.find(key);
  return found == object.end() || !found->is_array() ? json::array() : *found;
}

}  // namespace

FoxgloveServer::FoxgloveServer(std::string name, std::string session)
    : name_(std::move(name)), session_(std::move(session)) {}

int FoxgloveServer::open() {
  const int number = next_client_++;
  const json info{
      {"op", "serverInfo"}, {"name", name_}, {"capabilities", {"time"}}, {"sessionId", session_}};
  clients_[number].answers.push_back(text_of(info));
  return number;
}

void FoxgloveServer::close(int client) { clients_.erase(client); }

void FoxgloveServer::on_text(int number, std::string_view text) {
  const auto found = clients_.find(number);
  if (found == clients_.end()) return;
  Client& client = found->second;
  const json said = json::parse(text, nullptr, false);
  const std::string op = said.is_object() && said.contains("op") && said["op"].is_string()
                             ? said["op"].get<std::string>()
                             : "";
  if (op == "subscribe") {
    for (const json& wish : array_in(said, "subscriptions")) {
      const auto id = number_in(wish, "id"), channel = number_in(wish, "channelId");
      if (id && channel) subscribe(client, *id, *channel);
    }
  } else if (op == "unsubscribe") {
    for (const json& id : array_in(said, "subscriptionIds"))
      if (id.is_number_unsigned()) unsubscribe(client, id.get<std::uint64_t>());
  } else {
    warn(client, "only subscribe and unsubscribe are understood here");
  }
}

void FoxgloveServer::on_binary(int client, std::string_view) {
  const auto found = clients_.find(client);
  if (found != clients_.end()) warn(found->second, "nothing can be published here");
}

void FoxgloveServer::subscribe(Client& client, std::uint64_t number, std::uint64_t topic) {
  // Channels are told their topic's number and 1.
  if (topic < 1 || topic > topics_.size()) return warn(client, "there is no such channel");
  const bool is_free =
      number <= UINT32_MAX && !client.subscriptions.contains(static_cast<Number>(number));
  // As many subscriptions as topics are enough for anybody, and bound what waits.
  if (!is_free || client.subscriptions.size() >= kMostTopics)
    return warn(client, "this subscription cannot be had");
  Subscription& added = client.subscriptions[static_cast<Number>(number)];
  added.topic = static_cast<std::size_t>(topic - 1);
  if (newest_[added.topic]) added.add(newest_[added.topic]);
}

void FoxgloveServer::unsubscribe(Client& client, std::uint64_t number) {
  const bool was_there =
      number <= UINT32_MAX && client.subscriptions.erase(static_cast<Number>(number)) > 0;
  if (!was_there) warn(client, "there is no such subscription");
}

void FoxgloveServer::warn(Client& client, const std::string& sentence) {
  if (client.answers.size() >= kMostAnswers) return;
  client.answers.push_back(text_of({{"op", "status"}, {"level", kWarning}, {"message", sentence}}));
}

std::string FoxgloveServer::advertisement(std::size_t first) const {
  json channels = json::array();
  for (std::size_t i = first; i < topics_.size(); ++i)
    channels.push_back({{"id", i + 1},
                        {"topic", topics_[i].name},
                        {"encoding", "protobuf"},
                        {"schemaName", name_of(topics_[i].kind)},
                        {"schema", base64(schema_of(topics_[i].kind))},
                        {"schemaEncoding", "protobuf"}});
  return text_of({{"op", "advertise"}, {"channels", channels}});
}

std::optional<ClientFrame> FoxgloveServer::next(int number) {
  const auto found = clients_.find(number);
  if (found == clients_.end()) return std::nullopt;
  Client& client = found->second;
  if (!client.answers.empty()) {
    ClientFrame frame{true, std::move(client.answers.front())};
    client.answers.pop_front();
    return frame;
  }
  if (client.advertised < topics_.size())
    return ClientFrame{true, advertisement(std::exchange(client.advertised, topics_.size()))};
  if (const auto time_us = std::exchange(client.time_us, std::nullopt)) {
    ClientFrame frame{false, {kTime}};
    put(ns(*time_us), frame.bytes);
    return frame;
  }
  return next_message(client);
}

// Subscriptions have their turns, so that a busy one delays no other.
std::optional<ClientFrame> FoxgloveServer::next_message(Client& client) {
  auto at = client.subscriptions.upper_bound(client.served);
  for (std::size_t i = 0; i < client.subscriptions.size(); ++i, ++at) {
    if (at == client.subscriptions.end()) at = client.subscriptions.begin();
    if (at->second.waiting.empty()) continue;
    client.served = at->first;
    const Shared message = at->second.take();
    ClientFrame frame{false, {kMessageData}};
    put(at->first, frame.bytes);
    put(ns(message->utime_us), frame.bytes);
    frame.bytes += message->bytes;
    return frame;
  }
  return std::nullopt;
}

void FoxgloveServer::Subscription::add(const Shared& message) {
  waiting.push_back(message);
  bytes += message->bytes.size();
  while (waiting.size() > 1 && bytes > kWaitingBytes) take();
}

FoxgloveServer::Shared FoxgloveServer::Subscription::take() {
  Shared message = std::move(waiting.front());
  waiting.pop_front();
  bytes -= message->bytes.size();
  return message;
}

std::optional<std::size_t> FoxgloveServer::topic_number(const Topic& topic) {
  const auto found = std::ranges::find(topics_, topic);
  if (found != topics_.end()) return static_cast<std::size_t>(found - topics_.begin());
  if (topics_.size() >= kMostTopics) return std::nullopt;
  topics_.push_back(topic);
  newest_.emplace_back();
  return topics_.size() - 1;
}

bool FoxgloveServer::wants(const Topic& topic) {
  const auto number = topic_number(topic);
  const auto has = [&](const auto& client) {
    return std::ranges::any_of(client.second.subscriptions,
                               [&](const auto& each) { return each.second.topic == number; });
  };
  return number && std::ranges::any_of(clients_, has);
}

void FoxgloveServer::tell(const Topic& topic, std::int64_t utime_us, std::string bytes) {
  const auto number = topic_number(topic);
  if (!number) return;
  const Shared message = std::make_shared<Message>(Message{utime_us, std::move(bytes)});
  newest_[*number] = message;
  for (auto& [id, client] : clients_)
    for (auto& [subscription_id, subscription] : client.subscriptions)
      if (subscription.topic == *number) subscription.add(message);
}

void FoxgloveServer::tell_time(std::int64_t utime_us) {
  for (auto& [id, client] : clients_) client.time_us = utime_us;
}

}  // namespace voxlist::foreign
