/* Made by saras.safety.promela() from the tables of cpp/include/saras/safety: do not edit.
   script/verify-model --write makes it anew; a test compares. */

#define WAITING 0
#define READY 1
#define ENGAGED 2
#define HOLD 3
#define ESTOP 4

#define EV_NONE 0
#define EV_READY 1
#define EV_LOST 2
#define EV_FAULT 3
#define EV_ENGAGE 4
#define EV_ENGAGE_REFUSED 5
#define EV_HOLD 6
#define EV_DISENGAGE 7
#define EV_ESTOP 8
#define EV_ESTOP_RESET 9

#define ACT_SILENT 0
#define ACT_RELEASE 1
#define ACT_WITHDRAW 2
#define ACT_OFFER 3
#define ACT_ACCEPT 4
#define ACT_CLAIM 5

#define EVENT(estop, estop_latched, reset_asked, hold_asked, fault, disengage_asked, lost, engage_asked, holder_asks, all_there, aligned) \
  ((estop) -> EV_ESTOP : \
  ((estop_latched && reset_asked && !estop) -> EV_ESTOP_RESET : \
  ((hold_asked) -> EV_HOLD : \
  ((fault) -> EV_FAULT : \
  ((disengage_asked) -> EV_DISENGAGE : \
  ((lost) -> EV_LOST : \
  ((engage_asked && holder_asks && all_there && aligned && !lost) -> EV_ENGAGE : \
  ((engage_asked) -> EV_ENGAGE_REFUSED : \
  ((all_there) -> EV_READY : \
  EV_NONE)))))))))

#define NEXT(s, e) \
  (((s) == WAITING && (e) == EV_READY) -> READY : \
  (((s) == WAITING && (e) == EV_ENGAGE) -> READY : \
  (((s) == WAITING && (e) == EV_HOLD) -> HOLD : \
  (((s) == WAITING && (e) == EV_ESTOP) -> ESTOP : \
  (((s) == READY && (e) == EV_LOST) -> WAITING : \
  (((s) == READY && (e) == EV_ENGAGE) -> ENGAGED : \
  (((s) == READY && (e) == EV_HOLD) -> HOLD : \
  (((s) == READY && (e) == EV_ESTOP) -> ESTOP : \
  (((s) == ENGAGED && (e) == EV_LOST) -> HOLD : \
  (((s) == ENGAGED && (e) == EV_FAULT) -> HOLD : \
  (((s) == ENGAGED && (e) == EV_HOLD) -> HOLD : \
  (((s) == ENGAGED && (e) == EV_DISENGAGE) -> WAITING : \
  (((s) == ENGAGED && (e) == EV_ESTOP) -> ESTOP : \
  (((s) == HOLD && (e) == EV_ENGAGE) -> ENGAGED : \
  (((s) == HOLD && (e) == EV_DISENGAGE) -> WAITING : \
  (((s) == HOLD && (e) == EV_ESTOP) -> ESTOP : \
  (((s) == ESTOP && (e) == EV_ESTOP_RESET) -> HOLD : \
  (s))))))))))))))))))

#define NEXT_HOLDER(h, o, a, by) \
  (((h) == 0 && (o) == 0 && (a) == ACT_CLAIM && (by) == 1) -> 1 : \
  (((h) == 0 && (o) == 0 && (a) == ACT_CLAIM && (by) == 2) -> 2 : \
  (((h) == 0 && (o) == 1 && (a) == ACT_CLAIM && (by) == 1) -> 1 : \
  (((h) == 0 && (o) == 1 && (a) == ACT_CLAIM && (by) == 2) -> 2 : \
  (((h) == 0 && (o) == 2 && (a) == ACT_CLAIM && (by) == 1) -> 1 : \
  (((h) == 0 && (o) == 2 && (a) == ACT_CLAIM && (by) == 2) -> 2 : \
  (((h) == 1 && (o) == 0 && (a) == ACT_SILENT && (by) == 1) -> 0 : \
  (((h) == 1 && (o) == 0 && (a) == ACT_RELEASE && (by) == 1) -> 0 : \
  (((h) == 1 && (o) == 1 && (a) == ACT_SILENT && (by) == 1) -> 0 : \
  (((h) == 1 && (o) == 1 && (a) == ACT_RELEASE && (by) == 1) -> 0 : \
  (((h) == 1 && (o) == 2 && (a) == ACT_SILENT && (by) == 1) -> 0 : \
  (((h) == 1 && (o) == 2 && (a) == ACT_RELEASE && (by) == 1) -> 0 : \
  (((h) == 1 && (o) == 2 && (a) == ACT_ACCEPT && (by) == 2) -> 2 : \
  (((h) == 2 && (o) == 0 && (a) == ACT_SILENT && (by) == 2) -> 0 : \
  (((h) == 2 && (o) == 0 && (a) == ACT_RELEASE && (by) == 2) -> 0 : \
  (((h) == 2 && (o) == 1 && (a) == ACT_SILENT && (by) == 2) -> 0 : \
  (((h) == 2 && (o) == 1 && (a) == ACT_RELEASE && (by) == 2) -> 0 : \
  (((h) == 2 && (o) == 1 && (a) == ACT_ACCEPT && (by) == 1) -> 1 : \
  (((h) == 2 && (o) == 2 && (a) == ACT_SILENT && (by) == 2) -> 0 : \
  (((h) == 2 && (o) == 2 && (a) == ACT_RELEASE && (by) == 2) -> 0 : \
  (h)))))))))))))))))))))

#define NEXT_OFFERED(h, o, a, by) \
  (((h) == 0 && (o) == 1 && (a) == ACT_SILENT && (by) == 1) -> 0 : \
  (((h) == 0 && (o) == 1 && (a) == ACT_CLAIM && (by) == 1) -> 0 : \
  (((h) == 0 && (o) == 1 && (a) == ACT_CLAIM && (by) == 2) -> 0 : \
  (((h) == 0 && (o) == 2 && (a) == ACT_SILENT && (by) == 2) -> 0 : \
  (((h) == 0 && (o) == 2 && (a) == ACT_CLAIM && (by) == 1) -> 0 : \
  (((h) == 0 && (o) == 2 && (a) == ACT_CLAIM && (by) == 2) -> 0 : \
  (((h) == 1 && (o) == 0 && (a) == ACT_OFFER && (by) == 1) -> 2 : \
  (((h) == 1 && (o) == 1 && (a) == ACT_SILENT && (by) == 1) -> 0 : \
  (((h) == 1 && (o) == 1 && (a) == ACT_RELEASE && (by) == 1) -> 0 : \
  (((h) == 1 && (o) == 1 && (a) == ACT_WITHDRAW && (by) == 1) -> 0 : \
  (((h) == 1 && (o) == 1 && (a) == ACT_OFFER && (by) == 1) -> 2 : \
  (((h) == 1 && (o) == 1 && (a) == ACT_ACCEPT && (by) == 1) -> 0 : \
  (((h) == 1 && (o) == 2 && (a) == ACT_SILENT && (by) == 1) -> 0 : \
  (((h) == 1 && (o) == 2 && (a) == ACT_SILENT && (by) == 2) -> 0 : \
  (((h) == 1 && (o) == 2 && (a) == ACT_RELEASE && (by) == 1) -> 0 : \
  (((h) == 1 && (o) == 2 && (a) == ACT_WITHDRAW && (by) == 1) -> 0 : \
  (((h) == 1 && (o) == 2 && (a) == ACT_ACCEPT && (by) == 2) -> 0 : \
  (((h) == 2 && (o) == 0 && (a) == ACT_OFFER && (by) == 2) -> 1 : \
  (((h) == 2 && (o) == 1 && (a) == ACT_SILENT && (by) == 1) -> 0 : \
  (((h) == 2 && (o) == 1 && (a) == ACT_SILENT && (by) == 2) -> 0 : \
  (((h) == 2 && (o) == 1 && (a) == ACT_RELEASE && (by) == 2) -> 0 : \
  (((h) == 2 && (o) == 1 && (a) == ACT_WITHDRAW && (by) == 2) -> 0 : \
  (((h) == 2 && (o) == 1 && (a) == ACT_ACCEPT && (by) == 1) -> 0 : \
  (((h) == 2 && (o) == 2 && (a) == ACT_SILENT && (by) == 2) -> 0 : \
  (((h) == 2 && (o) == 2 && (a) == ACT_RELEASE && (by) == 2) -> 0 : \
  (((h) == 2 && (o) == 2 && (a) == ACT_WITHDRAW && (by) == 2) -> 0 : \
  (((h) == 2 && (o) == 2 && (a) == ACT_OFFER && (by) == 2) -> 1 : \
  (((h) == 2 && (o) == 2 && (a) == ACT_ACCEPT && (by) == 2) -> 0 : \
  (o)))))))))))))))))))))))))))))
