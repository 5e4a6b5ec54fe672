/* Modes and ownership of the arms, for SPIN: script/verify-model.

   The tables are those of the core (supervisor_tables.pml is made from them); by hand are what happens around them and
   the properties. Arm 0 is whole: two operators with their lease, all signs, silence counted in ticks. Arm 1 takes any
   event at any time and shares only the E-stop. Operators are as bad as can be: they send motion at every moment,
   whether or not they hold anything. */
#include "supervisor_tables.pml"

#define NOBODY 0
#define TICKS_MISSING_HOLD 2

byte state[2];
byte holder, offered_to; /* lease of arm 0 */
byte engaged_by;         /* whose engagement arm 0 is in */
byte missing;            /* ticks in a row without all there, while engaged */

/* What only the properties look at. */
byte mover;                /* operator who has moved arm 0 since the last tick */
byte moved_by;             /* operator who has moved arm 0 in this engagement */
bit pressed;               /* the last tick saw the E-stop button pressed */
bit engage_now, reset_now; /* event of the last tick */
bit explicit_now;          /* the last tick's event was an operator's word: engage, disengage, E-stop */
bit accepted_now;          /* the last tick's lease act was an acceptance */
bit helped;                /* from now on all is well, and the operators do what the documents say */

inline any_bit(b) {
  if
  :: b = 0
  :: b = 1
  fi
}

/* Arm 0's tick: lease first, then the one event of the signs, then the table. */
active proctype supervisor() {
  bit estop, reset, hold, fault, disengage, there, aligned, lost, acts;
  byte asks, act, by, event, event_1, next;
  do
  :: atomic {
       if
       :: helped ->
          reset = 1;
          there = 1;
          aligned = 1;
          if
          :: holder == NOBODY -> acts = 1; act = ACT_CLAIM; by = 1
          :: else -> asks = holder
          fi
       :: !helped ->
          any_bit(estop);
          any_bit(reset);
          any_bit(hold);
          any_bit(fault);
          any_bit(disengage);
          any_bit(there);
          any_bit(aligned);
          any_bit(acts);
          select (asks : 0 .. 2);
          if
          :: acts -> select (act : ACT_SILENT .. ACT_CLAIM); select (by : 1 .. 2)
          :: else
          fi
       fi;
       d_step {
         mover = NOBODY;
         accepted_now = 0;
         if
         :: acts ->
            accepted_now = (act == ACT_ACCEPT && offered_to == by);
            next = NEXT_HOLDER(holder, offered_to, act, by);
            offered_to = NEXT_OFFERED(holder, offered_to, act, by);
            holder = next
         :: else
         fi;
         if
         :: state[0] == ENGAGED ->
            missing = (there -> 0 : missing + 1);
            lost = (missing >= TICKS_MISSING_HOLD || holder == NOBODY || holder != engaged_by)
         :: else -> lost = (!there || holder == NOBODY)
         fi;
         event = EVENT(estop, (state[0] == ESTOP), reset, hold, fault, disengage, lost, (asks != NOBODY),
                       (asks != NOBODY && asks == holder), there, aligned);
         next = NEXT(state[0], event);
         if
         :: next != state[0] ->
            engaged_by = (next == ENGAGED -> holder : NOBODY);
            moved_by = NOBODY;
            missing = 0
         :: else
         fi;
         state[0] = next;
         /* The E-stop and its reset are of the whole. */
         if
         :: estop || reset ->
            event_1 = EVENT(estop, (state[1] == ESTOP), reset, 0, 0, 0, 0, 0, 0, 0, 0);
            next = NEXT(state[1], event_1);
            state[1] = next
         :: else
         fi;
         pressed = estop;
         engage_now = (event == EV_ENGAGE);
         reset_now = (event == EV_ESTOP_RESET);
         explicit_now = (event == EV_ENGAGE || event == EV_DISENGAGE || event == EV_ESTOP);
         estop = 0; reset = 0; hold = 0; fault = 0; disengage = 0; there = 0; aligned = 0; lost = 0; acts = 0;
         asks = 0; act = 0; by = 0; event = 0; event_1 = 0; next = 0
       }
     }
  :: atomic {
       !helped -> /* a tick of arm 1 */
       select (event : EV_NONE .. EV_DISENGAGE);
       d_step {
         next = NEXT(state[1], event);
         state[1] = next;
         event = 0;
         next = 0
       }
     }
  od
}

/* The arm's own gate: it moves for who is engaged and holds the lease, in the tick that says so. */
inline send_motion(who) {
  d_step {
    state[0] == ENGAGED && engaged_by == who && holder == who ->
    assert(moved_by == NOBODY || moved_by == who);
    mover = who;
    moved_by = who
  }
}

active proctype operator_1() {
  do
  :: send_motion(1)
  od
}

active proctype operator_2() {
  do
  :: send_motion(2)
  od
}

active proctype weather() {
  helped = 1
}

/* Who moves the arm holds its lease and asked for this very engagement. */
ltl one_holder { [] (mover == NOBODY || (mover == holder && mover == engaged_by && state[0] == ENGAGED)) }
/* From the start, and after every stop, nothing moves before the next engage. */
ltl no_motion_without_engage { [] ((state[0] != ENGAGED) -> ((mover == NOBODY) W engage_now)) }
/* In the tick that sees the button, both arms are in ESTOP, whatever else was asked. */
ltl estop_wins { [] (pressed -> (state[0] == ESTOP && state[1] == ESTOP && mover == NOBODY)) }
ltl estop_latched { [] ((state[0] == ESTOP) -> ((state[0] == ESTOP) W reset_now)) }
ltl hold_latched { [] ((state[0] == HOLD) -> ((state[0] == HOLD) W explicit_now)) }
/* From one operator to the other only through nobody, or by acceptance. */
ltl hand_over_explicit { [] ((holder == 1) -> ((holder == 1) W (holder == NOBODY || accepted_now))) }
/* A lease that is gone stops the arm in the same tick. */
ltl no_lease_no_engagement { [] ((state[0] == ENGAGED) -> (engaged_by != NOBODY && engaged_by == holder)) }
/* Whatever happened before: when all is well and the documented steps are done, the arm is engaged again. */
ltl recovers { [] (helped -> <> (state[0] == ENGAGED)) }
