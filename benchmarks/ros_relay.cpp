// The plainest graph that could carry the platform's data: a chain of roscpp nodes that compute nothing.
//   ros_relay gateway PORT CONSOLE_PORT OUT IN    a console's datagram becomes a message on OUT; one on IN becomes its
//   answer ros_relay relay IN OUT                        each message of IN goes out on OUT
// TCP_NODELAY and queues of one, as our nodes have them.
#include <geometry_msgs/PoseStamped.h>
#include <ros/ros.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "loopback_console.hpp"

namespace {

using geometry_msgs::PoseStamped;
using geometry_msgs::PoseStampedConstPtr;
const ros::TransportHints kNoDelay = ros::TransportHints().tcpNoDelay();

int relay(const std::string& in, const std::string& out) {
  ros::NodeHandle node;
  const ros::Publisher publisher = node.advertise<PoseStamped>(out, 1);
  const boost::function<void(const PoseStampedConstPtr&)> forward = [&](const PoseStampedConstPtr& message) {
    publisher.publish(message);
  };
  const ros::Subscriber subscriber = node.subscribe<PoseStamped>(in, 1, forward, ros::VoidConstPtr(), kNoDelay);
  ros::spin();
  return 0;
}

int gateway(int port, int console_port, const std::string& out, const std::string& in) {
  ros::NodeHandle node;
  const int descriptor = saras::benchmarks::bound_socket(port);
  const sockaddr_in console = saras::benchmarks::loopback(console_port);
  const ros::Publisher publisher = node.advertise<PoseStamped>(out, 1);
  // The sequence number and the console's time travel in the pose.
  const boost::function<void(const PoseStampedConstPtr&)> answer = [&](const PoseStampedConstPtr& message) {
    saras::TouchballDown down;
    down.session = 1;
    down.seq = message->header.seq;
    down.echo_session = 1;
    down.echo_seq = static_cast<std::uint64_t>(message->pose.position.x);
    down.echo_time_ns = static_cast<std::int64_t>(message->pose.position.y);
    const auto bytes = encode(down);
    sendto(descriptor, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&console), sizeof(console));
  };
  const ros::Subscriber subscriber = node.subscribe<PoseStamped>(in, 1, answer, ros::VoidConstPtr(), kNoDelay);
  std::thread receiver([&] {
    std::array<std::uint8_t, 2048> data;
    saras::TouchballUp up;
    while (ros::ok()) {
      const ssize_t size = recv(descriptor, data.data(), data.size(), 0);
      if (size <= 0 || decode(data.data(), static_cast<std::size_t>(size), up)) {
        continue;
      }
      PoseStamped message;
      message.header.stamp = ros::Time::now();
      message.pose.position.x = static_cast<double>(up.seq);
      message.pose.position.y = static_cast<double>(up.sender_time_ns);
      publisher.publish(message);
    }
  });
  ros::spin();
  receiver.join();
  close(descriptor);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "relay", ros::init_options::AnonymousName | ros::init_options::NoRosout);
  const std::string mode = argc > 1 ? argv[1] : "";
  if (mode == "relay" && argc == 4) {
    return relay(argv[2], argv[3]);
  }
  if (mode == "gateway" && argc == 6) {
    return gateway(std::atoi(argv[2]), std::atoi(argv[3]), argv[4], argv[5]);
  }
  std::fprintf(stderr, "usage: %s relay IN OUT | gateway PORT CONSOLE_PORT OUT IN\n", argv[0]);
  return 2;
}
