#include "voxlist/viewing/server/rules.h"

#include <gtest/gtest.h>

namespace voxlist::viewing {
namespace {

const Rules kRules{.port = 7668, .token = "secret"};

Asked file() { return {.method = "GET", .target = "/", .host = "127.0.0.1:7668"}; }

Asked upgrade() {
  Asked asked = file();
  asked.target = "/live";
  asked.origin = "http://127.0.0.1:7668";
  asked.subprotocols = "voxlist.live.v1";
  asked.wants_upgrade = true;
  return asked;
}

Asked command() {
  Asked asked = file();
  asked.method = "POST";
  asked.target = "/command/save";
  asked.origin = "http://127.0.0.1:7668";
  asked.content_type = "application/json";
  asked.token = "secret";
  return asked;
}

TEST(Rules, LetTheOwnPageDoAll) {
  EXPECT_EQ(rule(file(), kRules).deed, Deed::kFile);
  EXPECT_EQ(rule(upgrade(), kRules).deed, Deed::kUpgrade);
  EXPECT_EQ(rule(command(), kRules).deed, Deed::kCommand);
}

TEST(Rules, KnowEachNameOfThisMachine) {
  for (const char* host : {"127.0.0.1:7668", "localhost:7668", "[::1]:7668"}) {
    Asked asked = file();
    asked.host = host;
    EXPECT_EQ(rule(asked, kRules).deed, Deed::kFile) << host;
  }
}

TEST(Rules, LetAProgramThatIsNoPageLookOn) {
  Asked asked = upgrade();
  asked.origin.reset();
  EXPECT_EQ(rule(asked, kRules).deed, Deed::kUpgrade);
}

TEST(Rules, KnowTheirProtocolAmongOthers) {
  Asked asked = upgrade();
  asked.subprotocols = "foxglove.sdk.v1,  voxlist.live.v1";
  EXPECT_EQ(rule(asked, kRules).deed, Deed::kUpgrade);
}

// A program, or Foxglove's page, that asks for Foxglove's protocol.
Asked foreign_upgrade() {
  Asked asked = file();
  asked.subprotocols = "foxglove.websocket.v1";
  asked.wants_upgrade = true;
  return asked;
}

const Rules kForeignRules{.port = 7668,
                          .token = "secret",
                          .foreign_protocols = {"foxglove.sdk.v1", "foxglove.websocket.v1"},
                          .foreign_origins = {"https://viewer.example"}};

TEST(Rules, LetOthersViewersLookOnByTheirProtocol) {
  EXPECT_EQ(rule(foreign_upgrade(), kForeignRules).deed, Deed::kForeignUpgrade);
  EXPECT_EQ(*foreign_protocol(foreign_upgrade(), kForeignRules), "foxglove.websocket.v1");
  EXPECT_EQ(rule(foreign_upgrade(), kRules).deed, Deed::kRefuse);
  Asked asked = foreign_upgrade();
  asked.origin = "https://viewer.example";
  EXPECT_EQ(rule(asked, kForeignRules).deed, Deed::kForeignUpgrade);
  asked.origin = "https://evil.example";
  EXPECT_EQ(rule(asked, kForeignRules).status, 403U);
  asked.origin.reset();
  asked.host = "evil.example:7668";
  EXPECT_EQ(rule(asked, kForeignRules).status, 421U);
}

TEST(Rules, LetAllowedPagesElsewhereDoNothingElse) {
  Asked live = upgrade(), save = command();
  live.origin = save.origin = "https://viewer.example";
  EXPECT_EQ(rule(live, kForeignRules).status, 403U);
  EXPECT_EQ(rule(save, kForeignRules).status, 403U);
}

struct Wrong {
  const char* what;
  Asked (*good)();
  void (*spoil)(Asked&);
  unsigned status;
};

TEST(Rules, RefuseEverythingElse) {
  const Wrong wrongs[] = {
      {"no host", file, [](Asked& a) { a.host.reset(); }, 421},
      {"another host", file, [](Asked& a) { a.host = "evil.example:7668"; }, 421},
      {"a name that leads here", upgrade, [](Asked& a) { a.host = "localhost.evil.example:7668"; },
       421},
      {"another port", file, [](Asked& a) { a.host = "127.0.0.1:80"; }, 421},
      {"no port", command, [](Asked& a) { a.host = "127.0.0.1"; }, 421},
      {"another address", command, [](Asked& a) { a.host = "10.0.0.1:7668"; }, 421},
      {"two hosts", file, [](Asked& a) { a.repeats_a_header = true; }, 400},
      {"PUT", file, [](Asked& a) { a.method = "PUT"; }, 405},
      {"POST of a file", file, [](Asked& a) { a.method = "POST"; }, 405},
      {"OPTIONS of a command", command, [](Asked& a) { a.method = "OPTIONS"; }, 405},
      {"GET of a command", command, [](Asked& a) { a.method = "GET"; }, 405},
      {"a command without origin", command, [](Asked& a) { a.origin.reset(); }, 403},
      {"a command of another origin", command, [](Asked& a) { a.origin = "http://evil.example"; },
       403},
      {"a command of another port", command, [](Asked& a) { a.origin = "http://127.0.0.1:80"; },
       403},
      {"a command of a file", command, [](Asked& a) { a.origin = "null"; }, 403},
      {"https", command, [](Asked& a) { a.origin = "https://127.0.0.1:7668"; }, 403},
      {"no token", command, [](Asked& a) { a.token.reset(); }, 403},
      {"an empty token", command, [](Asked& a) { a.token = ""; }, 403},
      {"a wrong token", command, [](Asked& a) { a.token = "secreT"; }, 403},
      {"a longer token", command, [](Asked& a) { a.token = "secrets"; }, 403},
      {"a form", command, [](Asked& a) { a.content_type = "text/plain"; }, 415},
      {"no type", command, [](Asked& a) { a.content_type.reset(); }, 415},
      {"a stream for another origin", upgrade, [](Asked& a) { a.origin = "http://evil.example"; },
       403},
      {"a stream for a file", upgrade, [](Asked& a) { a.origin = "null"; }, 403},
      {"no subprotocol", upgrade, [](Asked& a) { a.subprotocols.reset(); }, 400},
      {"another subprotocol", upgrade, [](Asked& a) { a.subprotocols = "voxlist.live.v2"; }, 400},
      {"a stream elsewhere", upgrade, [](Asked& a) { a.target = "/"; }, 404},
      {"a stream by POST", upgrade, [](Asked& a) { a.method = "POST"; }, 405},
  };
  for (const Wrong& wrong : wrongs) {
    Asked asked = wrong.good();
    wrong.spoil(asked);
    const Ruling ruling = rule(asked, kRules);
    EXPECT_EQ(ruling.deed, Deed::kRefuse) << wrong.what;
    EXPECT_EQ(ruling.status, wrong.status) << wrong.what;
  }
}

TEST(Rules, LetNumbersButNoNamesInWhereTheAddressIsOpen) {
  const Rules open{.port = 7668, .token = "secret", .is_open = true};
  Asked asked = file();
  asked.host = "10.0.0.1:7668";
  EXPECT_EQ(rule(asked, open).deed, Deed::kFile);
  asked.host = "robot.example:7668";
  EXPECT_EQ(rule(asked, open).status, 421U);
}

}  // namespace
}  // namespace voxlist::viewing
