#include "services/relay/relay_service.h"
#include "voxlist/service/service.h"

int main(int argc, char** argv) {
  using namespace voxlist::services;
  return voxlist::service::run_service<RelayService, voxlist::fleet::RelayConfig>(
      argc, argv, {"relay", "Joins the robot's bus with a fleet's, channel by channel.", true});
}
