#include "voxlist/fleet/one_way.h"

#include <algorithm>
#include <utility>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/pointcloud_t.hpp>

#include "voxlist/bus/channel_pattern.h"

namespace voxlist::fleet {
namespace {

// An encoded message begins with its type's fingerprint, the most significant byte first.
bool is_of_type(bus::Bytes bytes, std::int64_t fingerprint) {
  if (bytes.size() < 8) return false;
  std::uint64_t begin = 0;
  for (const std::uint8_t byte : bytes.first(8)) begin = begin << 8U | byte;
  return begin == static_cast<std::uint64_t>(fingerprint);
}

bool is_raw_cloud(bus::Bytes bytes) {
  return is_of_type(bytes, pointcloud_t::getHash()) || is_of_type(bytes, keyframe_t::getHash());
}

}  // namespace

OneWay::OneWay(const std::vector<RelayChannel>& rows, Direction direction, Send send)
    : send_(std::move(send)), direction_(direction) {
  std::ranges::copy_if(rows, std::back_inserter(rows_),
                       [&](const RelayChannel& row) { return row.direction == direction; });
}

void OneWay::take(const std::string& robot, const std::string& name, const std::string& channel,
                  bus::Bytes bytes, std::int64_t now_us) {
  Stream* stream = stream_of(robot, name, channel, now_us);
  if (stream == nullptr) return;
  stream->last_us = now_us;
  if (!stream->clouds && is_raw_cloud(bytes)) {
    ++counters_[stream->row + "/raw_cloud"];
    return;
  }
  if (direction_ == Direction::kIn && stream->repeats.is_repeat(bytes, now_us)) {
    ++counters_[stream->row + "/repeated"];
    return;
  }
  if (!stream->waiting && stream->throttle.pass(bytes.size(), now_us))
    return pass(channel, *stream, bytes);
  wait(*stream, bytes);
}

void OneWay::wait(Stream& stream, bus::Bytes bytes) {
  if (stream.waiting) {
    ++counters_[stream.row + "/held_back"];
    waiting_bytes_ -= stream.waiting->size();
    stream.waiting.reset();
  }
  if (waiting_bytes_ + bytes.size() > kMostWaiting) {
    ++counters_[stream.row + "/too_much_waiting"];
    return;
  }
  waiting_bytes_ += bytes.size();
  stream.waiting.emplace(bytes.begin(), bytes.end());
}

void OneWay::tick(std::int64_t now_us) {
  for (auto& [channel, stream] : streams_) {
    if (!stream.waiting || !stream.throttle.pass(stream.waiting->size(), now_us)) continue;
    const std::vector<std::uint8_t> bytes = std::move(*stream.waiting);
    stream.waiting.reset();
    waiting_bytes_ -= bytes.size();
    pass(channel, stream, bytes);
  }
}

const RelayChannel* OneWay::row_of(const std::string& robot, const std::string& name) const {
  const auto row = std::ranges::find_if(rows_, [&](const RelayChannel& r) {
    return bus::matches(r.name, name) && (robot.empty() || bus::matches(r.robot, robot));
  });
  return row == rows_.end() ? nullptr : &*row;
}

OneWay::Stream* OneWay::stream_of(const std::string& robot, const std::string& name,
                                  const std::string& channel, std::int64_t now_us) {
  if (const auto known = streams_.find(channel); known != streams_.end()) return &known->second;
  const RelayChannel* row = row_of(robot, name);
  if (row == nullptr) return nullptr;
  if (streams_.size() >= kMostChannels)
    std::erase_if(streams_, [&](const auto& stream) {
      return !stream.second.waiting && now_us - stream.second.last_us > kSilent_us;
    });
  if (streams_.size() >= kMostChannels) {
    ++counters_["too_many_channels"];
    return nullptr;
  }
  const Throttle throttle(row->max_hz, row->max_kBps * 1e3);
  return &streams_.emplace(channel, Stream{row->name, row->clouds, throttle, now_us, {}, {}})
              .first->second;
}

void OneWay::pass(const std::string& channel, const Stream& stream, bus::Bytes bytes) {
  ++counters_[stream.row + "/passed"];
  send_(channel, bytes);
}

}  // namespace voxlist::fleet
