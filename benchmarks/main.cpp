// saras_benchmarks GROUP …: times the groups and prints {"rows": […], "check": […]}. script/bench runs it.
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "groups.hpp"

int main(int argc, char** argv) {
  using saras::benchmarks::Row;
  std::vector<Row> rows;
  for (int i = 1; i < argc; ++i) {
    std::vector<Row> group;
    if (std::strcmp(argv[i], "teleop") == 0) {
      group = saras::benchmarks::teleop_rows();
    } else if (std::strcmp(argv[i], "codec") == 0) {
      group = saras::benchmarks::codec_rows();
    } else {
      std::fprintf(stderr, "unknown group %s (known: teleop codec)\n", argv[i]);
      return 2;
    }
    rows.insert(rows.end(), group.begin(), group.end());
  }
  std::printf("{\"rows\": [");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::printf("%s\n  {\"group\": \"%s\", \"name\": \"%s\", \"p50\": %.1f, \"p99\": %.1f}", i ? "," : "",
                rows[i].group.c_str(), rows[i].name.c_str(), rows[i].p50_ns, rows[i].p99_ns);
  }
  std::printf("],\n \"check\": [");
  const std::vector<double> check = saras::benchmarks::teleop_check();
  for (std::size_t i = 0; i < check.size(); ++i) {
    std::printf("%s%.17g", i ? ", " : "", check[i]);
  }
  std::printf("]}\n");
  return 0;
}
