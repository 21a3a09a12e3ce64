#pragma once

#include <cstdint>

/// The LMS 200's commands and modes by their names in SICK's telegram listing. A reply has its
/// request's command with kReply; kPoweredOn and kRejected answer no command of their own.
namespace voxlist::scanner::lms200 {

inline constexpr std::uint8_t kReply = 0x80;

inline constexpr std::uint8_t kReset = 0x10;
inline constexpr std::uint8_t kSetMode = 0x20;
inline constexpr std::uint8_t kGetScan = 0x30;
inline constexpr std::uint8_t kGetStatus = 0x31;
inline constexpr std::uint8_t kGetErrors = 0x32;
inline constexpr std::uint8_t kGetType = 0x3A;
inline constexpr std::uint8_t kSetVariant = 0x3B;
inline constexpr std::uint8_t kGetConfiguration = 0x74;
inline constexpr std::uint8_t kSetConfiguration = 0x77;

inline constexpr std::uint8_t kPoweredOn = 0x90;
inline constexpr std::uint8_t kResetting = 0x91;
inline constexpr std::uint8_t kRejected = 0x92;
inline constexpr std::uint8_t kScan = kGetScan | kReply;

/// Modes: the first data byte of kSetMode.
inline constexpr std::uint8_t kInstallation = 0x00;  ///< with kPassword
inline constexpr std::uint8_t kDiagnosis = 0x10;
inline constexpr std::uint8_t kContinuous = 0x24;
inline constexpr std::uint8_t kOnRequest = 0x25;
inline constexpr std::uint8_t kPartialScans = 0x2A;
inline constexpr std::uint8_t k38400Baud = 0x40;
inline constexpr std::uint8_t k19200Baud = 0x41;
inline constexpr std::uint8_t k9600Baud = 0x42;
inline constexpr std::uint8_t k500000Baud = 0x48;

inline constexpr char kPassword[] = "SICK_LMS";

}  // namespace voxlist::scanner::lms200
