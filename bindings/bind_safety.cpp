#include <algorithm>

#include "law.hpp"
#include "rooms.hpp"
#include "saras/safety/supervisor.hpp"

namespace saras::bindings {
namespace {

void bind_safety_table(py::module_& m) {
  py::enum_<SafetyState>(m, "SafetyState", "State of one channel. The first four as saras_ros1/ChannelState.")
      .value("WAITING", SafetyState::kWaiting)
      .value("READY", SafetyState::kReady)
      .value("ENGAGED", SafetyState::kEngaged)
      .value("HOLD", SafetyState::kHold)
      .value("ESTOP", SafetyState::kEstop);
  py::enum_<CrtkState>(m, "CrtkState", "What others see, by CRTK's names.")
      .value("DISABLED", CrtkState::kDisabled)
      .value("ENABLED", CrtkState::kEnabled)
      .value("PAUSED", CrtkState::kPaused)
      .value("FAULT", CrtkState::kFault);
  py::enum_<SafetyEvent>(m, "SafetyEvent", "What happened to a channel in one step.")
      .value("NONE", SafetyEvent::kNone)
      .value("READY", SafetyEvent::kReady)
      .value("LOST", SafetyEvent::kLost)
      .value("FAULT", SafetyEvent::kFault)
      .value("ENGAGE", SafetyEvent::kEngage)
      .value("ENGAGE_REFUSED", SafetyEvent::kEngageRefused)
      .value("HOLD", SafetyEvent::kHold)
      .value("DISENGAGE", SafetyEvent::kDisengage)
      .value("ESTOP", SafetyEvent::kEstop)
      .value("ESTOP_RESET", SafetyEvent::kEstopReset);
  py::enum_<SafetySign>(m, "SafetySign", "Signs of one step, as bits for event_of.", py::arithmetic())
      .value("ESTOP", kSignEstop)
      .value("ESTOP_LATCHED", kSignEstopLatched)
      .value("RESET_ASKED", kSignResetAsked)
      .value("HOLD_ASKED", kSignHoldAsked)
      .value("FAULT", kSignFault)
      .value("DISENGAGE_ASKED", kSignDisengageAsked)
      .value("LOST", kSignLost)
      .value("ENGAGE_ASKED", kSignEngageAsked)
      .value("HOLDER_ASKS", kSignHolderAsks)
      .value("ALL_THERE", kSignAllThere)
      .value("ALIGNED", kSignAligned);
  Struct<EventRule>(m, "EventRule", "The first rule that fits the signs gives the event.")
      .field("event", &EventRule::event, "SafetyEvent")
      .field("all_of", &EventRule::all_of, "bits of SafetySign that must stand")
      .field("none_of", &EventRule::none_of, "bits of SafetySign that must not");
  m.attr("EVENT_RULES") = py::tuple(py::cast(kEventRules));
  m.def("event_of", &event_of, py::arg("signs"), "The one event that a set of SafetySign bits gives.");
  m.def("next_state", &next_state, py::arg("state"), py::arg("event"), "The state table.");
  m.def("crtk_state", &crtk_state, py::arg("state"), "How a channel's state is shown to CRTK clients.");
}

void bind_lease(py::module_& m) {
  py::enum_<LeaseAct>(m, "LeaseAct", "What an operator does to a lease.")
      .value("SILENT", LeaseAct::kSilent)
      .value("RELEASE", LeaseAct::kRelease)
      .value("WITHDRAW", LeaseAct::kWithdraw)
      .value("OFFER", LeaseAct::kOffer)
      .value("ACCEPT", LeaseAct::kAccept)
      .value("CLAIM", LeaseAct::kClaim);
  m.attr("NOBODY") = kNobody;
  m.attr("MAX_OPERATORS") = kMaxOperators;
  Struct<LeaseState>(m, "LeaseState", "All that a Lease remembers. Operators are 1..MAX_OPERATORS, 0 is nobody.")
      .field("holder", &LeaseState::holder, "operator who may move the arm")
      .field("offered_to", &LeaseState::offered_to, "operator who may take it over");
  m.def("next_lease", &next_lease, py::arg("state"), py::arg("act"), py::arg("by"), py::arg("to") = kNobody,
        "What one act of operator `by` does to a lease; an act that he may not do changes nothing.");
  Struct<OperatorSigns>(m, "OperatorSigns", "What one operator's console says in one step.")
      .field("alive", &OperatorSigns::alive, "heard within its limit")
      .field("claim", &OperatorSigns::claim, "asks for a free arm")
      .field("release", &OperatorSigns::release, "gives the arm back")
      .field("withdraw", &OperatorSigns::withdraw, "takes an offer back")
      .field("accept", &OperatorSigns::accept, "takes what was offered in an earlier step")
      .field("offer_to", &OperatorSigns::offer_to, "operator to whom the lease is offered; 0: nobody");
  Struct<LeaseOutput>(m, "LeaseOutput", "Result of Lease.step.")
      .field("holder", &LeaseOutput::holder, "operator who may move the arm; 0: nobody")
      .field("offered_to", &LeaseOutput::offered_to, "operator who may take it over; 0: nobody")
      .field("refused", &LeaseOutput::refused, "of each operator: asked for what he may not have now")
      .field("status", &LeaseOutput::status, "WAITING: nobody holds the arm");
  py::class_<Lease>(m, "Lease", "Who may move an arm: one operator at a time; silence releases to nobody.")
      .def(py::init<>())
      .def(
          "step",
          [](Lease& self, const std::vector<OperatorSigns>& operators, Seconds dt) {
            if (operators.size() > kMaxOperators) {
              throw py::value_error("operators: at most " + std::to_string(kMaxOperators) + ", got " +
                                    std::to_string(operators.size()));
            }
            LeaseInput input;
            std::copy(operators.begin(), operators.end(), input.operators.begin());
            return self.step(input, dt);
          },
          py::arg("operators"), py::arg("dt"),
          "One tick: OperatorSigns of operator 1, 2, …; who is left out is silent. dt [s] is only checked.")
      .def("reset", &Lease::reset, py::arg("state") = LeaseState{})
      .def_property_readonly("state", [](const Lease& self) { return self.state(); });
}

void bind_supervisor(py::module_& m) {
  m.attr("MAX_CHANNELS") = kMaxChannels;
  Struct<SupervisorConfig>(m, "SupervisorConfig", "Size and patience of a Supervisor.")
      .field("channels", &SupervisorConfig::channels, "1..MAX_CHANNELS")
      .field("steps_missing_hold", &SupervisorConfig::steps_missing_hold,
             "so many steps in a row without all there end an engagement");
  Struct<ChannelInput>(m, "ChannelInput", "What one channel reports in one step.")
      .field("all_there", &ChannelInput::all_there, "everything that the channel needs is fresh")
      .field("fault", &ChannelInput::fault, "in this step, such as a pose that jumped")
      .field("aligned", &ChannelInput::aligned, "hand and tool are aligned")
      .field("hold", &ChannelInput::hold, "asked for in this step")
      .field("disengage", &ChannelInput::disengage, "asked for in this step")
      .field("clutch", &ChannelInput::clutch, "pressed, a level")
      .field("holder", &ChannelInput::holder, "operator who holds the arm's lease; 0: nobody")
      .field("engage_by", &ChannelInput::engage_by, "operator who asks for engagement in this step; 0: nobody");
  Struct<ChannelOutput>(m, "ChannelOutput", "What one channel may do.")
      .field("state", &ChannelOutput::state, "SafetyState")
      .field("crtk", &ChannelOutput::crtk, "CrtkState")
      .field("event", &ChannelOutput::event, "SafetyEvent of this step")
      .field("may_move", &ChannelOutput::may_move, "engaged, clutch released, by who holds the lease")
      .field("engage_refused", &ChannelOutput::engage_refused, "somebody asked for engagement and did not get it")
      .field("engagement", &ChannelOutput::engagement, "counts engagements");
  Struct<SupervisorOutput>(m, "SupervisorOutput", "Result of Supervisor.step.")
      .field("channels", &SupervisorOutput::channels, "MAX_CHANNELS ChannelOutput; unused ones do not move")
      .field("whole", &SupervisorOutput::whole, "CrtkState")
      .field("estop_latched", &SupervisorOutput::estop_latched, "left by an explicit reset only")
      .field("status", &SupervisorOutput::status, "saras.Status");
  Struct<ChannelMemory>(m, "ChannelMemory", "What a Supervisor remembers of one channel.")
      .field("state", &ChannelMemory::state, "SafetyState")
      .field("cause", &ChannelMemory::cause, "SafetyEvent that led to this state")
      .field("engaged_by", &ChannelMemory::engaged_by, "operator whose engagement it is; 0: none")
      .field("steps_missing", &ChannelMemory::steps_missing, "steps in a row without all there")
      .field("engagement", &ChannelMemory::engagement, "counts engagements");
  Struct<SupervisorState>(m, "SupervisorState", "All that a Supervisor remembers.")
      .field("channels", &SupervisorState::channels, "MAX_CHANNELS ChannelMemory");
  py::class_<Supervisor>(m, "Supervisor", "Which channels may move. E-stop wins; a reset never moves.")
      .def(py::init<SupervisorConfig>(), py::arg("config") = SupervisorConfig{})
      .def(
          "step",
          [](Supervisor& self, const std::vector<ChannelInput>& channels, bool estop, bool estop_reset, Seconds dt) {
            const auto wanted = static_cast<std::size_t>(self.config().channels);
            if (channels.size() != wanted) {
              throw py::value_error("channels: expected " + std::to_string(wanted) + ", got " +
                                    std::to_string(channels.size()));
            }
            SupervisorInput input;
            std::copy(channels.begin(), channels.end(), input.channels.begin());
            input.estop = estop;
            input.estop_reset = estop_reset;
            return self.step(input, dt);
          },
          py::arg("channels"), py::kw_only(), py::arg("estop"), py::arg("estop_reset") = false, py::arg("dt"),
          "One tick: a ChannelInput each. estop: pressed, or not known. estop_reset: asked for now. dt [s] is only\n"
          "checked.")
      .def("reset", &Supervisor::reset, py::arg("state") = SupervisorState{})
      .def_property_readonly("config", [](const Supervisor& self) { return self.config(); })
      .def_property_readonly("state", [](const Supervisor& self) { return self.state(); });
}

}  // namespace

void bind_safety(py::module_& m) {
  bind_safety_table(m);
  bind_lease(m);
  bind_supervisor(m);
}

}  // namespace saras::bindings
