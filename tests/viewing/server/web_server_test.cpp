// The server as a raw socket sees it.
#include "voxlist/viewing/server/web_server.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "voxlist/system/file_descriptor.h"

namespace voxlist::viewing {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

FileDescriptor connect_to(std::uint16_t port) {
  FileDescriptor fd(socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(connect(fd.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  fcntl(fd.get(), F_SETFL, O_NONBLOCK);
  return fd;
}

struct Served {
  Served()
      : server({}, {[this] { return ++opened; }, [this](int) { ++closed; },
                    [this](int) { return take_frame(); },
                    [this](const std::string& name, const std::string& json) {
                      commands.push_back(name + json);
                      return CommandAnswer{};
                    },
                    foreign()}) {}

  // Says "hello" once, and keeps what it hears.
  ForeignProtocol foreign() {
    ForeignProtocol protocol;
    protocol.names = {"foreign.v2", "foreign.v1"};
    protocol.open = [this] { return ++foreign_opened; };
    protocol.close = [this](int) { ++foreign_closed; };
    protocol.next = [this](int) { return std::exchange(hello, std::nullopt); };
    protocol.hear = [this](int, std::string_view bytes, bool is_text) {
      foreign_heard.push_back(std::string(is_text ? "text " : "bytes ").append(bytes));
    };
    return protocol;
  }

  std::optional<Frame> take_frame() {
    if (frames == 0) return std::nullopt;
    --frames;
    return Frame(frame_bytes, 7);
  }

  std::string own() const { return "127.0.0.1:" + std::to_string(server.port()); }

  // Sends, and hears until `ends` or a closed line; enough polls for a frame of any size here.
  std::string talk(const FileDescriptor& fd, const std::string& text,
                   const std::string& ends = "\r\n\r\n") {
    EXPECT_EQ(send(fd.get(), text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
    std::string heard;
    char buffer[4096];
    for (int i = 0; i < 10'000 && heard.find(ends) == std::string::npos; ++i) {
      server.poll();
      const ssize_t got = recv(fd.get(), buffer, sizeof buffer, 0);
      if (got == 0) break;
      if (got > 0) heard.append(buffer, static_cast<std::size_t>(got));
    }
    return heard;
  }

  std::string ask(const std::string& text) {
    const FileDescriptor fd = connect_to(server.port());
    return talk(fd, text);
  }

  std::string upgrade(const std::string& path = "/live",
                      const std::string& protocols = "voxlist.live.v1") const {
    return "GET " + path + " HTTP/1.1\r\nHost: " + own() + "\r\nOrigin: http://" + own() +
           "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
           "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
           "Sec-WebSocket-Protocol: " +
           protocols + "\r\n\r\n";
  }

  std::string post(const std::string& extra, const std::string& body = "{}") const {
    return "POST /command/save HTTP/1.1\r\nHost: " + own() + "\r\nOrigin: http://" + own() +
           "\r\nContent-Type: application/json\r\n" + extra +
           "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
  }

  int opened = 0, closed = 0, frames = 0;
  std::size_t frame_bytes = 10;
  std::vector<std::string> commands, foreign_heard;
  std::optional<SocketMessage> hello = SocketMessage{"hello", true};
  int foreign_opened = 0, foreign_closed = 0;
  WebServer server;
};

TEST(WebServer, HandsOutThePageWithItsPolicy) {
  Served served;
  const std::string heard = served.ask("GET / HTTP/1.1\r\nHost: " + served.own() + "\r\n\r\n");
  EXPECT_THAT(heard, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(heard, HasSubstr("Content-Type: text/html"));
  EXPECT_THAT(heard, HasSubstr("default-src 'self'; frame-ancestors 'none'"));
  EXPECT_THAT(heard, HasSubstr("nosniff"));
  EXPECT_THAT(heard, Not(HasSubstr("Access-Control")));
  EXPECT_THAT(heard, HasSubstr("/main.js"));
}

TEST(WebServer, HasNoOtherFiles) {
  Served served;
  for (const char* path : {"/../etc/passwd", "/server/rules.h", "/%2e%2e/", "//", "/index.html/"})
    EXPECT_THAT(
        served.ask("GET " + std::string(path) + " HTTP/1.1\r\nHost: " + served.own() + "\r\n\r\n"),
        StartsWith("HTTP/1.1 404"))
        << path;
}

TEST(WebServer, ObeysACommandWithItsToken) {
  Served served;
  const std::string token = "X-Voxlist-Token: " + served.server.token() + "\r\n";
  EXPECT_THAT(served.ask(served.post(token)), StartsWith("HTTP/1.1 204"));
  EXPECT_THAT(served.commands, testing::ElementsAre("save{}"));
}

TEST(WebServer, RefusesWhatItShould) {
  Served served;
  const std::string token = "X-Voxlist-Token: " + served.server.token() + "\r\n";
  const std::string get = "GET / HTTP/1.1\r\nHost: " + served.own() + "\r\n";
  std::string foreign = served.upgrade();
  foreign.replace(foreign.find("http://127"), 10, "http://evi");
  std::string unknown = served.upgrade();
  unknown.replace(unknown.find("live.v1"), 7, "live.v9");
  const std::pair<std::string, const char*> wrongs[] = {
      {"GET / HTTP/1.1\r\n\r\n", "421"},
      {"GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n", "421"},
      {get + "Host: evil.example\r\n\r\n", "400"},
      {"DELETE / HTTP/1.1\r\nHost: " + served.own() + "\r\n\r\n", "405"},
      {served.post(""), "403"},
      {served.post("X-Voxlist-Token: 0\r\n"), "403"},
      {served.post(token + token), "400"},
      {served.post(token + "Origin: http://evil.example\r\n"), "400"},
      {served.post(token, std::string(70'000, ' ')), "413"},
      {get + "X: " + std::string(10'000, 'x') + "\r\n\r\n", "413"},
      {foreign, "403"},
      {unknown, "400"},
      {get + "Upgrade: websocket\r\nConnection: Upgrade\r\n\r\n", "404"},
      {"nonsense\r\n\r\n", "400"},
  };
  for (const auto& [text, status] : wrongs)
    EXPECT_THAT(served.ask(text), StartsWith(std::string("HTTP/1.1 ") + status))
        << text.substr(0, 200);
  EXPECT_TRUE(served.commands.empty());
  EXPECT_EQ(served.opened, 0);
  EXPECT_EQ(served.server.refused(), std::ssize(wrongs));
}

TEST(WebServer, StreamsFramesToAClient) {
  Served served;
  served.frames = 1;
  const FileDescriptor fd = connect_to(served.server.port());
  const std::string heard = served.talk(fd, served.upgrade(), std::string(10, 7));
  EXPECT_THAT(heard, StartsWith("HTTP/1.1 101"));
  EXPECT_THAT(heard, HasSubstr("Sec-WebSocket-Protocol: voxlist.live.v1"));
  EXPECT_THAT(heard, HasSubstr("\x82\x0a" + std::string(10, 7)));
  EXPECT_EQ(served.server.clients(), 1);
}

TEST(WebServer, SpeaksAForeignProtocolBesideItsOwn) {
  Served served;
  {
    const FileDescriptor fd = connect_to(served.server.port());
    const std::string answer = served.talk(fd, served.upgrade("/", "other, foreign.v1"), "hello");
    EXPECT_THAT(answer, HasSubstr("Sec-WebSocket-Protocol: foreign.v1\r\n"));
    EXPECT_THAT(answer, HasSubstr("\x81\x05hello"));
    // Masked by 0: "hi" as text, then as bytes.
    const std::string said("\x81\x82\0\0\0\0hi\x82\x82\0\0\0\0hi", 16);
    send(fd.get(), said.data(), said.size(), MSG_NOSIGNAL);
    for (int i = 0; i < 1000 && served.foreign_heard.size() < 2; ++i) served.server.poll();
    EXPECT_THAT(served.foreign_heard, testing::ElementsAre("text hi", "bytes hi"));
    EXPECT_EQ(served.opened, 0);
  }
  for (int i = 0; i < 1000 && served.foreign_closed == 0; ++i) served.server.poll();
  EXPECT_EQ(served.foreign_closed, 1);
}

TEST(WebServer, LetsAClientGo) {
  Served served;
  {
    const FileDescriptor fd = connect_to(served.server.port());
    served.talk(fd, served.upgrade());
  }
  for (int i = 0; i < 100 && served.closed == 0; ++i) served.server.poll();
  EXPECT_EQ(served.closed, 1);
  EXPECT_EQ(served.server.clients(), 0);
}

TEST(WebServer, HasNoMoreThanEightClients) {
  Served served;
  std::vector<FileDescriptor> clients;
  for (int i = 0; i < 8; ++i) {
    clients.push_back(connect_to(served.server.port()));
    EXPECT_THAT(served.talk(clients.back(), served.upgrade()), StartsWith("HTTP/1.1 101"));
  }
  EXPECT_THAT(served.ask(served.upgrade()), StartsWith("HTTP/1.1 503"));
}

TEST(WebServer, EndsAClientWhoseFrameIsTooLarge) {
  Served served;
  const FileDescriptor fd = connect_to(served.server.port());
  served.talk(fd, served.upgrade());
  // A masked frame that says it has 1 MB. The answer: "message too big".
  const std::string large("\x82\xff\x00\x00\x00\x00\x00\x10\x00\x00\x00\x00\x00\x00", 14);
  EXPECT_EQ(served.talk(fd, large, "\x03\xf1"), "\x88\x02\x03\xf1");
}

TEST(WebServer, HoldsOneFrameOfAClientThatReadsNothing) {
  Served served;
  const FileDescriptor fd = connect_to(served.server.port());
  served.talk(fd, served.upgrade());
  served.frame_bytes = 100'000;
  served.frames = 10'000;
  for (int i = 0; i < 1000; ++i) served.server.poll();
  // What the kernel holds, and one frame.
  EXPECT_GT(served.frames, 10'000 - 160);
  EXPECT_LT(served.frames, 10'000);
}

TEST(WebServer, ServesOnAfterFramesOfRandomBytes) {
  Served served;
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    const FileDescriptor fd = connect_to(served.server.port());
    ASSERT_THAT(served.talk(fd, served.upgrade()), StartsWith("HTTP/1.1 101")) << i;
    std::string frame(random() % 300 + 2, 0);
    for (char& byte : frame) byte = static_cast<char>(random());
    if (i % 2 == 0) frame[1] = static_cast<char>(0x80 | (random() % 126));  // masked, and as short
    send(fd.get(), frame.data(), frame.size(), MSG_NOSIGNAL);
    for (int poll = 0; poll < 5; ++poll) served.server.poll();
    shutdown(fd.get(), SHUT_RDWR);
    for (int poll = 0; poll < 100 && served.server.clients() > 0; ++poll) served.server.poll();
    ASSERT_EQ(served.server.clients(), 0) << i;
  }
  EXPECT_THAT(served.ask("GET / HTTP/1.1\r\nHost: " + served.own() + "\r\n\r\n"),
              StartsWith("HTTP/1.1 200"));
}

}  // namespace
}  // namespace voxlist::viewing
