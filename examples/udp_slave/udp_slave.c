/* A slave arm at the far end of CSA UDP (docs/protocols.md): one file, libc only. Build: make, or cc -O2 udp_slave.c -lm
 *
 *   udp_slave --listen 127.0.0.1:48031 --platform 127.0.0.1:48030 [--key FILE] [--joints 7]
 *
 * It simulates a PSM (joints 6), or one on a turntable (joints 7): each joint follows its set-point with a lag. To drive
 * your own robot, replace what stands under "the arm"; the rest is the protocol: datagrams, authentication, and the
 * rules of what may be followed. */
#define _POSIX_C_SOURCE 200809L
#include <arpa/inet.h>
#include <errno.h>
#include <math.h>
#include <netinet/in.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { UP = 548, DOWN = 252, HELLO = 60, TAG = 16, TRAILER = 20, MAX_JOINTS = 12 };
enum { MODE_HOLD, MODE_JOINTS, MODE_CARTESIAN };
enum { FOLLOWS, NOT_ENGAGED, NO_SET_POINT, REFUSED };
static const char* const kHold[] = {"FOLLOWS", "NOT_ENGAGED", "NO_SET_POINT", "REFUSED"};
static const int64_t kMs = 1000000;
static const double kPi = 3.14159265358979323846;

/* ---- numbers on the wire: little-endian, without padding */

static void put(uint8_t* at, uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) at[i] = (uint8_t)(value >> (8 * i));
}
static uint64_t get(const uint8_t* at, int bytes) {
  uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value |= (uint64_t)at[i] << (8 * i);
  return value;
}
static void put_f64(uint8_t* at, double value) {
  uint64_t bits;
  memcpy(&bits, &value, 8);
  put(at, bits, 8);
}
static double get_f64(const uint8_t* at) {
  const uint64_t bits = get(at, 8);
  double value;
  memcpy(&value, &bits, 8);
  return value;
}

static uint32_t crc32(const uint8_t* data, size_t size) {
  uint32_t rest = 0xFFFFFFFFu;
  for (size_t i = 0; i < size; ++i) {
    rest ^= data[i];
    for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1) ^ ((rest & 1u) ? 0xEDB88320u : 0u);
  }
  return ~rest;
}

/* ---- HMAC-SHA-256 (FIPS 180-4, RFC 2104) */

typedef struct {
  uint32_t h[8];
  uint8_t block[64];
  uint64_t size;
} Sha;

static const uint32_t kSha[64] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

static uint32_t turn(uint32_t value, int by) { return value >> by | value << (32 - by); }

static void sha_block(Sha* sha) {
  uint32_t w[64], s[8];
  for (int i = 0; i < 16; ++i) {
    const uint8_t* b = sha->block + 4 * i;
    w[i] = (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
  }
  for (int i = 16; i < 64; ++i) {
    const uint32_t a = turn(w[i - 15], 7) ^ turn(w[i - 15], 18) ^ w[i - 15] >> 3;
    const uint32_t b = turn(w[i - 2], 17) ^ turn(w[i - 2], 19) ^ w[i - 2] >> 10;
    w[i] = w[i - 16] + a + w[i - 7] + b;
  }
  memcpy(s, sha->h, sizeof s);
  for (int i = 0; i < 64; ++i) {
    const uint32_t choice = (s[4] & s[5]) ^ (~s[4] & s[6]);
    const uint32_t t = s[7] + (turn(s[4], 6) ^ turn(s[4], 11) ^ turn(s[4], 25)) + choice + kSha[i] + w[i];
    const uint32_t majority = (s[0] & s[1]) ^ (s[0] & s[2]) ^ (s[1] & s[2]);
    const uint32_t u = (turn(s[0], 2) ^ turn(s[0], 13) ^ turn(s[0], 22)) + majority;
    memmove(s + 1, s, 7 * sizeof *s);
    s[4] += t;
    s[0] = t + u;
  }
  for (int i = 0; i < 8; ++i) sha->h[i] += s[i];
}

static void sha_begin(Sha* sha) {
  static const uint32_t first[8] = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                    0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  memcpy(sha->h, first, sizeof first);
  sha->size = 0;
}
static void sha_add(Sha* sha, const uint8_t* data, size_t size) {
  for (size_t i = 0; i < size; ++i) {
    sha->block[sha->size++ % 64] = data[i];
    if (sha->size % 64 == 0) sha_block(sha);
  }
}
static void sha_end(Sha* sha, uint8_t digest[32]) {
  const uint64_t bits = 8 * sha->size;
  const uint8_t one = 0x80, zero = 0;
  uint8_t length[8];
  for (int i = 0; i < 8; ++i) length[i] = (uint8_t)(bits >> (56 - 8 * i));
  sha_add(sha, &one, 1);
  while (sha->size % 64 != 56) sha_add(sha, &zero, 1);
  sha_add(sha, length, 8);
  for (int i = 0; i < 32; ++i) digest[i] = (uint8_t)(sha->h[i / 4] >> (24 - 8 * (i % 4)));
}

static void hmac(const uint8_t key[32], const uint8_t* data, size_t size, uint8_t digest[32]) {
  Sha sha;
  uint8_t pad[64];
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < 64; ++i) pad[i] = (uint8_t)((i < 32 ? key[i] : 0) ^ (pass ? 0x5c : 0x36));
    sha_begin(&sha);
    sha_add(&sha, pad, 64);
    sha_add(&sha, pass ? digest : data, pass ? 32 : size);
    sha_end(&sha, digest);
  }
}

/* ---- frame of all datagrams */

static void header(uint8_t* data, const char* magic, int keyed) {
  memcpy(data, magic, 4);
  put(data + 4, 1, 2);
  put(data + 6, keyed ? 1 : 0, 2);
}
static void seal(uint8_t* data, size_t size, const uint8_t* key) {
  uint8_t digest[32] = {0};
  if (key) hmac(key, data, size - TRAILER, digest);
  memcpy(data + size - TRAILER, digest, TAG);
  put(data + size - 4, crc32(data, size - 4), 4);
}
/* Why a datagram is not one of this kind; "" when it is. Length, magic, version, flag; tag; checksum: in this order. */
static const char* frame_fault(const uint8_t* data, size_t size, size_t wanted, const char* magic,
                               const uint8_t* key) {
  uint8_t digest[32] = {0}, differ = 0;
  if (size != wanted) return "size";
  if (memcmp(data, magic, 4)) return "magic";
  if (get(data + 4, 2) != 1) return "version";
  if (get(data + 6, 2) != (key ? 1u : 0u)) return "flags";
  if (key) hmac(key, data, size - TRAILER, digest);
  for (int i = 0; i < TAG; ++i) differ |= (uint8_t)(digest[i] ^ data[size - TRAILER + (size_t)i]);
  if (differ) return "authentication";
  if (get(data + size - 4, 4) != crc32(data, size - 4)) return "checksum";
  return "";
}

/* ---- what comes down and goes up */

typedef struct {
  uint64_t session, seq, echo_session, engagement;
  int64_t time_ns, echo_hold_ns;
  uint32_t mode, joints;
  double q[MAX_JOINTS], p[3], quaternion[4]; /* x y z w */
} Down;

static const char* decode(const uint8_t* data, size_t size, const uint8_t* key, Down* down) {
  const char* fault = frame_fault(data, size, DOWN, "SCSD", key);
  if (*fault) return fault;
  down->session = get(data + 8, 8);
  down->seq = get(data + 16, 8);
  down->time_ns = (int64_t)get(data + 24, 8);
  down->echo_session = get(data + 32, 8);
  down->echo_hold_ns = (int64_t)get(data + 56, 8);
  down->mode = (uint32_t)get(data + 64, 4);
  down->joints = (uint32_t)get(data + 68, 4);
  down->engagement = get(data + 72, 8);
  if (down->mode > MODE_CARTESIAN) return "mode";
  if (down->mode == MODE_JOINTS ? down->joints < 1 || down->joints > MAX_JOINTS : down->joints != 0) return "joints";
  for (uint32_t i = 0; i < MAX_JOINTS; ++i) {
    down->q[i] = get_f64(data + 80 + 8 * i);
    if (!isfinite(down->q[i]) || (i >= down->joints && down->q[i] != 0.0)) return "position";
  }
  for (int i = 0; i < 3; ++i) {
    down->p[i] = get_f64(data + 176 + 8 * i);
    if (!(fabs(down->p[i]) <= 10.0)) return "tip_position";
  }
  double square = 0.0;
  for (int i = 0; i < 4; ++i) {
    down->quaternion[i] = get_f64(data + 200 + 8 * i);
    square += down->quaternion[i] * down->quaternion[i];
  }
  return fabs(sqrt(square) - 1.0) <= 1e-6 ? "" : "tip_quaternion";
}

typedef struct {
  int joints, hold, has_force;
  uint64_t engagement;
  double q[MAX_JOINTS], v[MAX_JOINTS], p[3], quaternion[4], twist[6], wrench[6];
} State;

typedef struct {
  uint64_t session, seq, echo_session, echo_seq;
  int64_t time_ns, echo_time_ns, echo_hold_ns;
} Stream;

static void encode(const State* state, const Stream* stream, const uint8_t* key, uint8_t data[UP]) {
  memset(data, 0, UP);
  header(data, "SCSU", key != NULL);
  put(data + 8, stream->session, 8);
  put(data + 16, stream->seq, 8);
  put(data + 24, (uint64_t)stream->time_ns, 8);
  put(data + 32, stream->echo_session, 8);
  put(data + 40, stream->echo_seq, 8);
  put(data + 48, (uint64_t)stream->echo_time_ns, 8);
  put(data + 56, (uint64_t)stream->echo_hold_ns, 8);
  put(data + 64, 1u | (state->has_force ? 2u : 0u), 4); /* homed; has_force */
  put(data + 68, 1, 4);                                 /* ENABLED */
  put(data + 72, (uint64_t)state->hold, 4);
  put(data + 76, (uint64_t)state->joints, 4);
  put(data + 80, state->engagement, 8);
  for (int i = 0; i < state->joints; ++i) {
    put_f64(data + 88 + 8 * i, state->q[i]);
    put_f64(data + 184 + 8 * i, state->v[i]);
  }
  for (int i = 0; i < 3; ++i) put_f64(data + 376 + 8 * i, state->p[i]);
  for (int i = 0; i < 4; ++i) put_f64(data + 400 + 8 * i, state->quaternion[i]);
  for (int i = 0; i < 6; ++i) put_f64(data + 432 + 8 * i, state->twist[i]);
  for (int i = 0; i < 6; ++i) put_f64(data + 480 + 8 * i, state->wrench[i]);
  seal(data, UP, key);
}

/* ---- the arm: a PSM about its remote centre, joint 0 of seven a turntable under it. Replace this by your own. */

static const double kReach0 = 0.4162 - 0.4318, kWrist = 0.0091, kLag_s = 0.02;
static const double kLower[6] = {-1.588, -0.925025, 0.0, -4.53786, -1.39626, -1.39626};
static const double kUpper[6] = {1.588, 0.925025, 0.240, 4.53786, 1.39626, 1.39626};
static const double kStart[6] = {0.1, -0.1, 0.15, 0.2, 0.1, -0.1};

typedef struct {
  int joints;
  double q[7], v[7], goal[7], p[3], r[3][3], jacobian[6][7]; /* r: columns are the tip's axes */
  double tissue_height, tissue_stiffness;                    /* elastic below z = height; stiffness 0: no force sensor */
} Arm;

static void cross(const double a[3], const double b[3], double out[3]) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}
static void mix(double u, const double a[3], double v, const double b[3], double out[3]) {
  for (int i = 0; i < 3; ++i) out[i] = u * a[i] + v * b[i];
}
static void turn_z(double angle, double v[3]) {
  const double x = v[0];
  v[0] = cos(angle) * x - sin(angle) * v[1];
  v[1] = sin(angle) * x + cos(angle) * v[1];
}

static int first_psm_joint(const Arm* arm) { return arm->joints - 6; }

/* Tip and Jacobian (linear first, base axes) at the joints q. */
static void kinematics(Arm* arm, const double* all) {
  const double* q = all + first_psm_joint(arm);
  const double s1 = sin(q[0]), c1 = cos(q[0]), s2 = sin(q[1]), c2 = cos(q[1]);
  const double x[3] = {-s1 * s2, -c2, c1 * s2}, y[3] = {-c1, 0.0, -s1}, shaft[3] = {c2 * s1, -s2, -c2 * c1};
  const double yaw[3] = {0.0, -1.0, 0.0};
  double x4[3], z5[3], x5[3], z6[3], x6[3], wrist[3], zx[3], axes[6][3], arms[6][3];
  mix(cos(q[3]), x, sin(q[3]), y, x4);
  mix(-sin(q[3]), x, cos(q[3]), y, z5);
  mix(sin(q[4]), x4, cos(q[4]), shaft, x5);
  cross(z5, x5, z6);
  mix(sin(q[5]), x5, cos(q[5]), z5, x6);
  mix(kWrist, x5, 0.0, x5, wrist);
  mix(q[2] + kReach0, shaft, 1.0, wrist, arm->p);
  cross(z6, x6, zx);
  const double* turning[6] = {yaw, y, NULL, shaft, z5, z6};
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 3; ++k) {
      axes[i][k] = turning[i] ? turning[i][k] : 0.0;
      arms[i][k] = i == 2 ? shaft[k] : 0.0;
    }
    if (i < 2) cross(axes[i], arm->p, arms[i]);
    if (i == 3 || i == 4) cross(axes[i], wrist, arms[i]);
  }
  const int first = first_psm_joint(arm);
  double columns[3][3];
  for (int k = 0; k < 3; ++k) columns[0][k] = -z6[k], columns[1][k] = -x6[k], columns[2][k] = zx[k];
  if (first) {
    const double up[3] = {0.0, 0.0, 1.0};
    turn_z(all[0], arm->p);
    for (int i = 0; i < 3; ++i) turn_z(all[0], columns[i]);
    for (int i = 0; i < 6; ++i) turn_z(all[0], axes[i]), turn_z(all[0], arms[i]);
    double lever[3];
    cross(up, arm->p, lever);
    for (int k = 0; k < 3; ++k) arm->jacobian[k][0] = lever[k], arm->jacobian[3 + k][0] = up[k];
  }
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) arm->r[k][i] = columns[i][k];
    for (int i = 0; i < 6; ++i) arm->jacobian[k][first + i] = arms[i][k], arm->jacobian[3 + k][first + i] = axes[i][k];
  }
}

static void to_quaternion(double r[3][3], double q[4]) {
  const double squares[4] = {1 + r[0][0] - r[1][1] - r[2][2], 1 - r[0][0] + r[1][1] - r[2][2],
                             1 - r[0][0] - r[1][1] + r[2][2], 1 + r[0][0] + r[1][1] + r[2][2]};
  int largest = 0;
  for (int i = 1; i < 4; ++i) largest = squares[i] > squares[largest] ? i : largest;
  const double products[4][4] = {{squares[0], r[1][0] + r[0][1], r[0][2] + r[2][0], r[2][1] - r[1][2]},
                                 {r[1][0] + r[0][1], squares[1], r[2][1] + r[1][2], r[0][2] - r[2][0]},
                                 {r[0][2] + r[2][0], r[2][1] + r[1][2], squares[2], r[1][0] - r[0][1]},
                                 {r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1], squares[3]}};
  double norm = 0.0;
  for (int i = 0; i < 4; ++i) q[i] = products[largest][i], norm += q[i] * q[i];
  norm = q[3] < 0.0 ? -sqrt(norm) : sqrt(norm);
  for (int i = 0; i < 4; ++i) q[i] /= norm;
}

/* Displacement (linear first, base axes) from the arm's tip to a pose: what the Jacobian is to make. */
static void displacement(const Arm* arm, const double p[3], const double to[4], double delta[6]) {
  double now[4], r[3][3];
  memcpy(r, arm->r, sizeof r);
  to_quaternion(r, now);
  /* to * conjugate(now) */
  double d[4] = {-to[3] * now[0] + to[0] * now[3] - to[1] * now[2] + to[2] * now[1],
                 -to[3] * now[1] + to[0] * now[2] + to[1] * now[3] - to[2] * now[0],
                 -to[3] * now[2] - to[0] * now[1] + to[1] * now[0] + to[2] * now[3],
                 to[3] * now[3] + to[0] * now[0] + to[1] * now[1] + to[2] * now[2]};
  if (d[3] < 0.0)
    for (int i = 0; i < 4; ++i) d[i] = -d[i];
  const double size = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  const double factor = size > 1e-12 ? 2.0 * atan2(size, d[3]) / size : 2.0;
  for (int i = 0; i < 3; ++i) delta[i] = p[i] - arm->p[i], delta[3 + i] = factor * d[i];
}

static double clip(double value, double lower, double upper) { return fmin(fmax(value, lower), upper); }

static void clip_joints(const Arm* arm, double* q) {
  const int first = first_psm_joint(arm);
  if (first) q[0] = clip(q[0], -kPi, kPi);
  for (int i = 0; i < 6; ++i) q[first + i] = clip(q[first + i], kLower[i], kUpper[i]);
}

/* Joints for a pose, near the goal before: damped least squares, so that nothing runs away at a singularity. */
static void goal_for_pose(Arm* arm, const double p[3], const double quaternion[4]) {
  for (int pass = 0; pass < 5; ++pass) {
    double e[6], a[6][7];
    kinematics(arm, arm->goal);
    displacement(arm, p, quaternion, e);
    for (int i = 0; i < 6; ++i) {
      for (int k = 0; k < 6; ++k) {
        a[i][k] = i == k ? 1e-6 : 0.0;
        for (int j = 0; j < arm->joints; ++j) a[i][k] += arm->jacobian[i][j] * arm->jacobian[k][j];
      }
      a[i][6] = e[i];
    }
    for (int i = 0; i < 6; ++i) /* positive definite: no pivoting */
      for (int k = i + 1; k < 6; ++k) {
        const double factor = a[k][i] / a[i][i];
        for (int j = i; j < 7; ++j) a[k][j] -= factor * a[i][j];
      }
    for (int i = 5; i >= 0; --i) {
      for (int k = i + 1; k < 6; ++k) a[i][6] -= a[i][k] * a[k][6];
      a[i][6] /= a[i][i];
    }
    for (int j = 0; j < arm->joints; ++j)
      for (int i = 0; i < 6; ++i) arm->goal[j] += arm->jacobian[i][j] * a[i][6];
    clip_joints(arm, arm->goal);
  }
}

static void move(Arm* arm, double dt) {
  for (int i = 0; i < arm->joints; ++i) {
    const int is_insertion = i - first_psm_joint(arm) == 2;
    const double step = (is_insertion ? 0.3 : 3.0) * dt;
    const double change = clip((1.0 - exp(-dt / kLag_s)) * (arm->goal[i] - arm->q[i]), -step, step);
    arm->v[i] = change / dt;
    arm->q[i] += change;
  }
}

static void measure(Arm* arm, State* state) {
  kinematics(arm, arm->q);
  state->joints = arm->joints;
  memcpy(state->q, arm->q, sizeof arm->q);
  memcpy(state->v, arm->v, sizeof arm->v);
  memcpy(state->p, arm->p, sizeof arm->p);
  to_quaternion(arm->r, state->quaternion);
  for (int i = 0; i < 6; ++i) {
    state->twist[i] = state->wrench[i] = 0.0;
    for (int j = 0; j < arm->joints; ++j) state->twist[i] += arm->jacobian[i][j] * arm->v[j];
  }
  state->has_force = arm->tissue_stiffness > 0.0;
  state->wrench[2] = -arm->tissue_stiffness * fmax(0.0, arm->tissue_height - arm->p[2]); /* on the tissue */
}

/* ---- what of the set-points may be followed */

typedef struct {
  int hold;
  uint64_t engagement;
  int64_t heard_ns;
} Gate;

static void end_engagement(Gate* gate, int hold) {
  gate->hold = hold;
  printf("holds: %s\n", kHold[hold]);
}

static int out_of_reach(const Arm* arm, const Down* down) {
  if (down->mode == MODE_JOINTS) {
    if ((int)down->joints != arm->joints) return 1;
    for (int i = 0; i < arm->joints; ++i)
      if (!(fabs(down->q[i] - arm->q[i]) <= (i - first_psm_joint(arm) == 2 ? 0.02 : 0.35))) return 1;
    return 0;
  }
  double delta[6];
  displacement(arm, down->p, down->quaternion, delta); /* from where measure() left the kinematics: the arm's tip */
  return !(sqrt(delta[0] * delta[0] + delta[1] * delta[1] + delta[2] * delta[2]) <= 0.02 &&
           sqrt(delta[3] * delta[3] + delta[4] * delta[4] + delta[5] * delta[5]) <= 0.35);
}

/* Whether this datagram is to be followed. */
static int gate_takes(Gate* gate, const Arm* arm, const Down* down, int64_t now_ns) {
  if (down->mode == MODE_HOLD) {
    if (gate->hold == FOLLOWS) end_engagement(gate, NOT_ENGAGED);
    return 0;
  }
  if (down->engagement != gate->engagement) { /* a new one, whatever ended the last */
    gate->engagement = down->engagement;
    gate->hold = FOLLOWS;
    printf("follows engagement %llu\n", (unsigned long long)gate->engagement);
  }
  if (gate->hold != FOLLOWS) return 0;
  if (out_of_reach(arm, down)) {
    end_engagement(gate, REFUSED);
    return 0;
  }
  gate->heard_ns = now_ns;
  return 1;
}

/* ---- the link: session, replay window, newest wins, age */

typedef struct {
  int keyed, has_session, is_heard, is_new, has_age;
  uint8_t up[32], down[32], up_key[32], down_key[32]; /* of the file; of the session */
  uint8_t asked[16], console_nonce[16], confirmation[HELLO];
  int has_asked, has_confirmation;
  int64_t asked_ns, next_ns, proven_ns, began_ns;
  uint64_t newest, window, session, seq; /* replay window; newest wins */
  double least_ns;
  int64_t first_offset_ns, last_ns;
  unsigned long refused;
} Link;

static void draw(uint8_t nonce[16]) {
  FILE* file = fopen("/dev/urandom", "rb");
  if (!file || fread(nonce, 1, 16, file) != 16) {
    fprintf(stderr, "udp_slave: no random numbers\n");
    exit(1);
  }
  fclose(file);
}

static void hello(const Link* link, const uint8_t nonce[16], const uint8_t* echo, uint8_t data[HELLO]) {
  memset(data, 0, HELLO);
  header(data, "SCSH", 1);
  memcpy(data + 8, nonce, 16);
  if (echo) memcpy(data + 24, echo, 16);
  seal(data, HELLO, link->up);
}

/* The message of the handshake that is due now; 0: none. */
static int handshake_due(Link* link, int64_t now_ns, uint8_t data[HELLO]) {
  if (link->next_ns && now_ns < link->next_ns) return 0;
  if (link->has_session && now_ns - link->proven_ns < 500 * kMs) {
    if (!link->has_confirmation) return 0;
    link->next_ns = now_ns + 100 * kMs;
    memcpy(data, link->confirmation, HELLO);
    return 1;
  }
  link->next_ns = now_ns + 100 * kMs;
  if (!link->has_asked || now_ns - link->asked_ns > 1000 * kMs) {
    draw(link->asked);
    link->has_asked = 1;
    link->asked_ns = now_ns;
  }
  hello(link, link->asked, NULL, data);
  return 1;
}

/* The platform's answer; 1: `data` is the confirmation to send. */
static int take_answer(Link* link, uint8_t data[HELLO], int64_t now_ns) {
  static const char label[] = "saras csa session 1";
  uint8_t context[sizeof label - 1 + 32];
  if (*frame_fault(data, HELLO, HELLO, "SCSH", link->down)) return ++link->refused, 0;
  if (link->has_session && !memcmp(data + 24, link->console_nonce, 16)) return 0; /* to a question sent twice */
  if (!link->has_asked || memcmp(data + 24, link->asked, 16) || now_ns - link->asked_ns > 2000 * kMs)
    return ++link->refused, 0;
  hello(link, link->asked, data + 8, link->confirmation);
  memcpy(context, label, sizeof label - 1);
  memcpy(context + sizeof label - 1, link->asked, 16);
  memcpy(context + sizeof label - 1 + 16, data + 8, 16);
  hmac(link->up, context, sizeof context, link->up_key);
  hmac(link->down, context, sizeof context, link->down_key);
  memcpy(link->console_nonce, link->asked, 16);
  link->has_session = link->has_confirmation = link->is_new = 1;
  link->has_asked = link->is_heard = link->has_age = 0;
  link->window = 0;
  link->began_ns = link->proven_ns = now_ns;
  link->next_ns = now_ns + 100 * kMs;
  memcpy(data, link->confirmation, HELLO);
  printf("authenticated session begun\n");
  return 1;
}

/* Newest 64 numbers of a session: whether this one is new. */
static int window_takes(Link* link, uint64_t seq) {
  if (!link->window) return link->newest = seq, link->window = 1, 1;
  if (seq > link->newest) {
    const uint64_t ahead = seq - link->newest;
    if (ahead > 1u << 20) return 0;
    link->window = (ahead < 64 ? link->window << ahead : 0) | 1;
    return link->newest = seq, 1;
  }
  const uint64_t behind = link->newest - seq;
  if (behind >= 64 || link->window >> behind & 1) return 0;
  return link->window |= (uint64_t)1 << behind, 1;
}

/* Age above the least delay, which is forgotten by 5 ms a second. */
static double age_s(Link* link, int64_t sent_ns, int64_t now_ns) {
  const int64_t offset = (int64_t)((uint64_t)now_ns - (uint64_t)sent_ns);
  if (!link->has_age) {
    link->has_age = 1;
    link->first_offset_ns = offset;
    link->least_ns = 0.0;
    link->last_ns = now_ns;
  }
  const double relative = (double)(int64_t)((uint64_t)offset - (uint64_t)link->first_offset_ns);
  link->least_ns = fmin(link->least_ns + 5e-3 * (double)(now_ns - link->last_ns), relative);
  link->last_ns = now_ns;
  return 1e-9 * (relative - link->least_ns);
}

/* 1: `down` is a set-point, newer than all before. */
static int take_data(Link* link, const uint8_t* data, size_t size, uint64_t own_session, Down* down, int64_t now_ns) {
  if (link->keyed && !link->has_session) return ++link->refused, 0;
  if (*decode(data, size, link->keyed ? link->down_key : NULL, down)) return ++link->refused, 0;
  if (link->keyed) {
    if (!link->is_heard && now_ns - link->began_ns > 2000 * kMs) return ++link->refused, 0;
    if (!window_takes(link, down->seq)) return ++link->refused, 0;
    link->is_heard = 1;
    link->has_confirmation = 0;
    if (down->echo_session == own_session && down->echo_hold_ns < 500 * kMs) link->proven_ns = now_ns, link->has_asked = 0;
  }
  if (!link->is_new && (down->session < link->session || (down->session == link->session && down->seq <= link->seq)))
    return 0;
  if (link->is_new || down->session != link->session) link->has_age = 0;
  link->is_new = 0;
  link->session = down->session;
  link->seq = down->seq;
  return age_s(link, down->time_ns, now_ns) <= 0.1;
}

/* ---- program */

static volatile sig_atomic_t stop;
static void on_signal(int number) { stop = number; }

static void fail(const char* what, const char* why) {
  fprintf(stderr, "udp_slave: %s: %s\n", what, why);
  exit(2);
}

static int64_t clock_ns(clockid_t clock) {
  struct timespec now;
  clock_gettime(clock, &now);
  return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static size_t from_hex(const char* text, uint8_t* bytes, size_t most) {
  size_t count = 0;
  for (; text[0] && text[1] && count < most; text += 2) {
    const char digits[3] = {text[0], text[1], 0};
    char* end;
    bytes[count++] = (uint8_t)strtoul(digits, &end, 16);
    if (*end) fail("hexadecimal", text);
  }
  return *text ? most + 1 : count;
}

static void read_key(const char* path, const char* text, const char* name, uint8_t key[32]) {
  char digits[65] = {0};
  const char* at = strstr(text, name);
  if (!at || sscanf(at + strlen(name), " : \"%64[0-9a-fA-F]\"", digits) != 1 || strlen(digits) != 64)
    fail(path, "not a key file of: saras keys make FILE");
  from_hex(digits, key, 32);
}

static void load_keys(const char* path, Link* link) {
  char text[4097] = {0};
  struct stat status;
  FILE* file = fopen(path, "rb");
  if (!file || fstat(fileno(file), &status)) fail(path, strerror(errno));
  if (status.st_mode & 077) fail(path, "others can read it: chmod 600");
  if (!fread(text, 1, sizeof text - 1, file) || !strstr(text, "\"saras touchball keys\""))
    fail(path, "not a key file of: saras keys make FILE");
  fclose(file);
  read_key(path, text, "\"up\"", link->up);
  read_key(path, text, "\"down\"", link->down);
  link->keyed = 1;
}

static struct sockaddr_in address(const char* text, int keyed) {
  struct sockaddr_in made = {.sin_family = AF_INET};
  char host[64];
  unsigned port;
  if (sscanf(text, "%63[0-9.]:%u", host, &port) != 2 || port > 65535 || inet_pton(AF_INET, host, &made.sin_addr) != 1)
    fail(text, "must be A.B.C.D:PORT");
  if (!keyed && ntohl(made.sin_addr.s_addr) >> 24 != 127) fail(text, "must be loopback, or give both ends --key FILE");
  made.sin_port = htons((uint16_t)port);
  return made;
}

/* For tests: what a datagram means, and what a state of known numbers looks like as bytes. */
static int show(const char* hex, const uint8_t* key) {
  uint8_t data[2048];
  Down down;
  const size_t size = from_hex(hex, data, sizeof data);
  const char* fault = decode(data, size, key, &down);
  if (*fault) return printf("refused: %s\n", fault), 1;
  printf("session %llu seq %llu engagement %llu mode %u joints %u", (unsigned long long)down.session,
         (unsigned long long)down.seq, (unsigned long long)down.engagement, down.mode, down.joints);
  for (uint32_t i = 0; i < down.joints; ++i) printf(" %.17g", down.q[i]);
  printf(" tip %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", down.p[0], down.p[1], down.p[2], down.quaternion[0],
         down.quaternion[1], down.quaternion[2], down.quaternion[3]);
  return 0;
}
static int example(int joints, const uint8_t* key) {
  const Stream stream = {.session = 0x0123456789ABCDEF, .seq = 42, .time_ns = -7, .echo_session = 5, .echo_seq = 6,
                         .echo_time_ns = 7, .echo_hold_ns = 8};
  State state = {.joints = joints, .hold = REFUSED, .has_force = 1, .engagement = 9, .p = {0.25, -0.5, 0.125},
                 .quaternion = {0.5, 0.5, -0.5, 0.5}};
  uint8_t data[UP];
  for (int i = 0; i < joints; ++i) state.q[i] = 0.5 * i, state.v[i] = -0.25 * i;
  for (int i = 0; i < 6; ++i) state.twist[i] = i, state.wrench[i] = -1.0 * i;
  encode(&state, &stream, key, data);
  for (int i = 0; i < UP; ++i) printf("%02x", data[i]);
  return printf("\n"), 0;
}
/* Tip of given joints: position, then the rotation row by row. */
static int forward(Arm* arm, char** numbers, int count) {
  if (count != arm->joints) fail("--forward", "needs a number for each joint");
  for (int i = 0; i < count; ++i) arm->q[i] = atof(numbers[i]);
  kinematics(arm, arm->q);
  printf("%.17g %.17g %.17g", arm->p[0], arm->p[1], arm->p[2]);
  for (int i = 0; i < 9; ++i) printf(" %.17g", arm->r[i / 3][i % 3]);
  return printf("\n"), 0;
}

int main(int argc, char** argv) {
  const char *listen_on = "127.0.0.1:48031", *platform_at = "127.0.0.1:48030", *decode_hex = NULL;
  static Link link = {.is_new = 1};
  static Arm arm = {.joints = 6};
  uint8_t test_key[32];
  int has_test_key = 0, wants_example = 0;
  double rate_hz = 200.0, duration_s = 0.0, timeout_s = 0.1;
  for (int i = 1; i < argc; ++i) {
    const char* option = argv[i];
    if (!strcmp(option, "--example")) {
      wants_example = 1;
      continue;
    }
    if (!strcmp(option, "--forward")) return forward(&arm, argv + i + 1, argc - i - 1);
    if (i + 1 == argc) fail(option, "unknown option, or its value is missing; see the top of udp_slave.c");
    const char* value = argv[++i];
    if (!strcmp(option, "--listen")) listen_on = value;
    else if (!strcmp(option, "--platform")) platform_at = value;
    else if (!strcmp(option, "--key")) load_keys(value, &link);
    else if (!strcmp(option, "--joints")) arm.joints = atoi(value);
    else if (!strcmp(option, "--rate-hz")) rate_hz = atof(value);
    else if (!strcmp(option, "--duration-s")) duration_s = atof(value);
    else if (!strcmp(option, "--timeout-s")) timeout_s = atof(value);
    else if (!strcmp(option, "--tissue-height-m")) arm.tissue_height = atof(value);
    else if (!strcmp(option, "--tissue-stiffness-N-m")) arm.tissue_stiffness = atof(value);
    else if (!strcmp(option, "--session-key")) has_test_key = from_hex(value, test_key, 32) == 32;
    else if (!strcmp(option, "--decode")) decode_hex = value;
    else fail(option, "unknown option; see the top of udp_slave.c");
  }
  if (arm.joints != 6 && arm.joints != 7) fail("--joints", "must be 6 or 7");
  if (!(rate_hz >= 10.0 && rate_hz <= 5000.0)) fail("--rate-hz", "must be in 10 ... 5000");
  if (!(timeout_s >= 0.01 && timeout_s <= 5.0)) fail("--timeout-s", "must be in 0.01 ... 5");
  if (decode_hex) return show(decode_hex, has_test_key ? test_key : NULL);
  if (wants_example) return example(arm.joints, has_test_key ? test_key : NULL);

  struct sockaddr_in own = address(listen_on, link.keyed), platform = address(platform_at, link.keyed);
  const int sock = socket(AF_INET, SOCK_DGRAM, 0);
  if (sock < 0 || bind(sock, (struct sockaddr*)&own, sizeof own)) fail(listen_on, strerror(errno));
  socklen_t length = sizeof own;
  getsockname(sock, (struct sockaddr*)&own, &length);
  setvbuf(stdout, NULL, _IOLBF, 0);
  printf("%d joints, listens on %s:%d\n", arm.joints, inet_ntoa(own.sin_addr), ntohs(own.sin_port));
  signal(SIGINT, on_signal);
  signal(SIGTERM, on_signal);

  memcpy(arm.q + first_psm_joint(&arm), kStart, sizeof kStart);
  memcpy(arm.goal, arm.q, sizeof arm.q);
  Gate gate = {.hold = NOT_ENGAGED};
  Stream stream = {.session = (uint64_t)clock_ns(CLOCK_REALTIME)};
  State state;
  Down newest = {0};
  int64_t newest_at_ns = 0;
  const double dt = 1.0 / rate_hz;
  const int64_t begin_ns = clock_ns(CLOCK_MONOTONIC), period_ns = (int64_t)(1e9 * dt);
  int64_t due_ns = begin_ns;
  while (!stop && (duration_s <= 0.0 || due_ns - begin_ns < (int64_t)(1e9 * duration_s))) {
    const int64_t now_ns = clock_ns(CLOCK_MONOTONIC);
    uint8_t data[2048];
    measure(&arm, &state);
    for (int i = 0; i < 64; ++i) { /* a flood must not hold the arm */
      struct sockaddr_in from;
      Down down;
      length = sizeof from;
      const ssize_t size = recvfrom(sock, data, sizeof data, MSG_DONTWAIT, (struct sockaddr*)&from, &length);
      if (size < 0) break;
      if (from.sin_addr.s_addr != platform.sin_addr.s_addr) {
        ++link.refused;
      } else if (link.keyed && size == HELLO) {
        if (take_answer(&link, data, now_ns))
          sendto(sock, data, HELLO, 0, (struct sockaddr*)&platform, sizeof platform);
      } else if (take_data(&link, data, (size_t)size, stream.session, &down, now_ns)) {
        newest = down;
        newest_at_ns = now_ns;
        if (gate_takes(&gate, &arm, &down, now_ns)) {
          if (down.mode == MODE_JOINTS) {
            memcpy(arm.goal, down.q, sizeof arm.goal);
            clip_joints(&arm, arm.goal);
          } else {
            goal_for_pose(&arm, down.p, down.quaternion);
            kinematics(&arm, arm.q);
          }
        }
      }
    }
    if (gate.hold == FOLLOWS && now_ns - gate.heard_ns > (int64_t)(1e9 * timeout_s)) end_engagement(&gate, NO_SET_POINT);
    if (gate.hold != FOLLOWS) memcpy(arm.goal, arm.q, sizeof arm.q); /* stands where it is */
    move(&arm, dt);

    measure(&arm, &state);
    state.hold = gate.hold;
    state.engagement = gate.engagement;
    ++stream.seq;
    stream.time_ns = clock_ns(CLOCK_MONOTONIC);
    if (newest_at_ns) {
      stream.echo_session = newest.session;
      stream.echo_seq = newest.seq;
      stream.echo_time_ns = newest.time_ns;
      stream.echo_hold_ns = stream.time_ns - newest_at_ns;
    }
    if (link.keyed && handshake_due(&link, now_ns, data))
      sendto(sock, data, HELLO, 0, (struct sockaddr*)&platform, sizeof platform);
    if (!link.keyed || link.has_session) {
      encode(&state, &stream, link.keyed ? link.up_key : NULL, data);
      sendto(sock, data, UP, 0, (struct sockaddr*)&platform, sizeof platform);
    }

    due_ns += period_ns;
    const int64_t rest_ns = clock_ns(CLOCK_MONOTONIC);
    if (due_ns < rest_ns) due_ns = rest_ns; /* late: no burst to catch up */
    const struct timespec until = {due_ns / 1000000000, due_ns % 1000000000};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL);
  }
  printf("ends; refused %lu datagrams\n", link.refused);
  close(sock);
  return 0;
}
