#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "voxlist/bus/multicast/delivery.h"
#include "voxlist/bus/traffic.h"
#include "voxlist/bus/wire.h"

namespace voxlist::bus {

struct BusOptions;

/// A message as it came, nothing checked. Valid during the call that hands it over.
struct RawMessage {
  std::string channel;
  Bytes bytes;
  std::int64_t arrival_utime_us = 0;
};

/// Moves bytes for Bus. Channel names have the prefix already.
class Transport {
 public:
  enum class Received { kMessage, kNothing, kEnded };
  using Receiver = std::function<void(const RawMessage&)>;

  virtual ~Transport() = default;

  /// Wants messages of the channels that one of the patterns matches (channel_pattern.h); up to
  /// `capacity` wait for receive(), then the newest are dropped.
  virtual void listen(const std::vector<std::string>& patterns, int capacity) = 0;

  /// False: it could not be sent.
  virtual bool send(const std::string& channel, Bytes bytes, Delivery delivery) = 0;

  /// Hands one message to `receiver`, waiting for it up to `timeout`, or until `wake_fd` (unless
  /// -1) can be read.
  virtual Received receive(std::chrono::milliseconds timeout, int wake_fd,
                           const Receiver& receiver) = 0;

  /// How many messages one Bus::handle() may take.
  virtual int batch() const = 0;

  /// Can be read when a message waits; -1: there is no such thing.
  virtual int file_descriptor() const { return -1; }

  /// See Bus::traffic().
  virtual Traffic traffic() const { return {}; }
};

/// The network, or memq. Throws std::runtime_error when it cannot connect.
std::unique_ptr<Transport> open_lcm(const BusOptions& options);

/// A recording, as fast as it is asked for. Throws std::runtime_error when it cannot be read.
std::unique_ptr<Transport> open_log(const std::string& path);

}  // namespace voxlist::bus
