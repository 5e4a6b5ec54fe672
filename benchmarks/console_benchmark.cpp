// A console on loopback for another process: console_benchmark PLATFORM_PORT OWN_PORT RATE_HZ
// Each line of its input ends a phase; it prints that phase's round trips as a line of JSON. Ends with its input.
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>

#include "loopback_console.hpp"

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: %s PLATFORM_PORT OWN_PORT RATE_HZ\n", argv[0]);
    return 2;
  }
  int own_port = std::atoi(argv[2]);
  const int descriptor = saras::benchmarks::bound_socket(own_port);
  {
    saras::benchmarks::LoopbackConsole console(descriptor, std::atoi(argv[1]), std::atof(argv[3]));
    for (std::string line; std::getline(std::cin, line);) {
      std::printf("{");
      saras::benchmarks::print_json("round_trip", console.round_trip.end_phase());
      std::printf("}\n");
      std::fflush(stdout);
    }
  }
  close(descriptor);
  return 0;
}
