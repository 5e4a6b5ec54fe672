// Ages of messages where they arrive: ros_meter TOPIC[:TYPE] …   TYPE: pose (default) or wrench
// Headers of the platform's topics keep the arrival of the console's datagram that they come from: the age of a message
// is the time from there to here. Each line of the input ends a phase and prints it as a line of JSON.
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/ros.h>

#include <cstdio>
#include <iostream>
#include <list>
#include <string>

#include "phase_histogram.hpp"

namespace {

struct Meter {
  std::string topic;
  saras::benchmarks::PhaseHistogram ages;
  ros::Subscriber subscriber;

  template <typename Message>
  void subscribe(ros::NodeHandle& node) {
    const boost::function<void(const boost::shared_ptr<const Message>&)> on_message =
        [this](const boost::shared_ptr<const Message>& message) {
          ages.record((ros::Time::now() - message->header.stamp).toNSec());
        };
    subscriber =
        node.subscribe<Message>(topic, 100, on_message, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  }
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "latency_meter", ros::init_options::AnonymousName | ros::init_options::NoRosout);
  ros::NodeHandle node;
  std::list<Meter> meters;
  for (int i = 1; i < argc; ++i) {
    const std::string wanted = argv[i];
    const std::size_t colon = wanted.find(':');
    Meter& meter = meters.emplace_back();
    meter.topic = wanted.substr(0, colon);
    if (colon != std::string::npos && wanted.substr(colon + 1) == "wrench") {
      meter.subscribe<geometry_msgs::WrenchStamped>(node);
    } else {
      meter.subscribe<geometry_msgs::PoseStamped>(node);
    }
  }
  ros::AsyncSpinner spinner(1);
  spinner.start();
  for (std::string line; std::getline(std::cin, line) && ros::ok();) {
    std::printf("{");
    const char* comma = "";
    for (Meter& meter : meters) {
      std::printf("%s", comma);
      saras::benchmarks::print_json(meter.topic.c_str(), meter.ages.end_phase());
      comma = ", ";
    }
    std::printf("}\n");
    std::fflush(stdout);
  }
  return 0;
}
