#include "bind_csa.hpp"
#include "rooms.hpp"

PYBIND11_MODULE(_core, m) {
  m.doc() =
      "The saras core. Import the rooms: saras.teleop, saras.kinematics, saras.collision, saras.sim,\n"
      "saras.net.";
  saras::bindings::bind_spatial(m);
  auto teleop = m.def_submodule("teleop", "Frame mapping, transparency, energy tanks, velocity integrator");
  saras::bindings::bind_teleop(teleop);
  auto kinematics = m.def_submodule("kinematics", "Chains, the SARAS arm, the da Vinci");
  saras::bindings::bind_kinematics(kinematics);
  auto collision = m.def_submodule("collision", "Distances between tools and forbidden regions");
  saras::bindings::bind_collision(collision);
  auto calibration = m.def_submodule("calibration", "Base frames from touched dots, hand-eye, the board");
  saras::bindings::bind_calibration(calibration);
  auto sim = m.def_submodule("sim", "Simulated arm, tissue, hand and network");
  saras::bindings::bind_sim(sim);
  auto net = m.def_submodule("net", "Datagram codecs");
  saras::bindings::bind_net(net);
  auto safety = m.def_submodule("safety", "State table of the channels, supervisor, leases");
  saras::bindings::bind_safety(safety);
  auto console = m.def_submodule("console", "What the console program steps at device rate");
  saras::bindings::bind_console(console);
  auto csa = m.def_submodule("csa", "Complementary situational awareness: controllers, fixtures, teleoperation states");
  saras::bindings::bind_csa(csa);
  auto pipeline = m.def_submodule("pipeline", "Both sides of the teleoperation in one step");
  saras::bindings::bind_pipeline(pipeline);
  auto overlay = m.def_submodule("overlay", "What the surgeons see on the endoscope's images");
  saras::bindings::bind_overlay(overlay);
  auto contact = m.def_submodule("contact", "Force of a contact that a camera sees");
  saras::bindings::bind_contact(contact);
  auto model = m.def_submodule("model", "What touch tells of stiffness and shape");
  saras::bindings::bind_model(model);
#ifdef SARAS_WITH_RUNTIME
  auto runtime = m.def_submodule("runtime", "The real-time host: loop, mailboxes, flight recorder");
  saras::bindings::bind_runtime(runtime);
#endif
}
