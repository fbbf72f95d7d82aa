/* A plain DDS node that speaks ROS 2's types: usage: ros2_node_cyclonedds DOMAIN COMMAND ...
 *   imu TOPIC PROFILE           prints sensor_msgs/Imu; PROFILE: sensor-data (BEST_EFFORT, depth 5) or default (RELIABLE, depth 10)
 *   diagnostics TOPIC PROFILE   prints diagnostic_msgs/DiagnosticArray, one status per line
 *   robot                       four IMUs of a robot that turns at (0.1, 0.2, -0.3) rad/s, on rt/imu_1/data to rt/imu_4/data, 200 Hz;
 *                               each SIGUSR1 changes what is wrong: the second is silent, well, late, well,
 *                               ahead, well, doubled, well; then the third has a bias of 0.05 rad/s about its own x
 *   biased                      three IMUs with biases of 0.2 to 0.6 deg/s on rt/imu_1/data to rt/imu_3/data, 200 Hz: at rest for 12 s,
 *                               then turning about all axes from the stamp that it prints; from SIGUSR1 on the third one's z axis
 *                               measures 0.4 of its rate
 * Ends on SIGTERM. */
#include <dds/dds.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "ros2_msgs.h"

enum { IMUS = 4 };
#define PERIOD_NS DDS_MSECS(5)
#define DELAY_NS DDS_MSECS(300)

static volatile sig_atomic_t stop = 0, orders = 0;
static void on_order(int number)
{
    (void)number;
    orders = orders + 1;
}
static void on_signal(int number)
{
    (void)number;
    stop = 1;
}

static dds_entity_t made(dds_entity_t entity, const char* what)
{
    if (entity >= 0) return entity;
    fprintf(stderr, "%s: %s\n", what, dds_strretcode(-entity));
    exit(1);
}

static dds_qos_t* profile(const char* name)
{
    const int sensor_data = strcmp(name, "sensor-data") == 0;
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, sensor_data ? DDS_RELIABILITY_BEST_EFFORT : DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
    dds_qset_durability(qos, DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, sensor_data ? 5 : 10);
    return qos;
}

static void print_imu(const sensor_msgs_msg_dds__Imu_* m)
{
    printf("%d.%09u %s q %.17g %.17g %.17g %.17g covariance %.9g rate %.9g %.9g %.9g covariance %.9g acceleration covariance %.9g\n",
           m->header_.stamp_.sec_, m->header_.stamp_.nanosec_, m->header_.frame_id_, m->orientation_.w_, m->orientation_.x_,
           m->orientation_.y_, m->orientation_.z_, m->orientation_covariance_[0], m->angular_velocity_.x_, m->angular_velocity_.y_,
           m->angular_velocity_.z_, m->angular_velocity_covariance_[0], m->linear_acceleration_covariance_[0]);
}

static void print_diagnostics(const diagnostic_msgs_msg_dds__DiagnosticArray_* m)
{
    for (uint32_t i = 0; i < m->status_._length; ++i)
        printf("%u|%s|%s|%s\n", m->status_._buffer[i].level_, m->status_._buffer[i].name_, m->status_._buffer[i].message_,
               m->status_._buffer[i].hardware_id_);
}

static int read_topic(dds_entity_t participant, const char* command, const char* topic_name, const char* profile_name)
{
    const int imu = strcmp(command, "imu") == 0;
    const dds_topic_descriptor_t* type = imu ? &sensor_msgs_msg_dds__Imu__desc : &diagnostic_msgs_msg_dds__DiagnosticArray__desc;
    dds_qos_t* qos = profile(profile_name);
    const dds_entity_t reader = made(
        dds_create_reader(participant, made(dds_create_topic(participant, type, topic_name, NULL, NULL), "topic"), qos, NULL), "reader");
    dds_delete_qos(qos);
    const dds_entity_t waitset = made(dds_create_waitset(participant), "wait set");
    dds_waitset_attach(waitset, made(dds_create_readcondition(reader, DDS_ANY_STATE), "condition"), 0);
    while (!stop) {
        dds_attach_t triggered;
        dds_waitset_wait(waitset, &triggered, 1, DDS_MSECS(100));
        void* loan[1] = {NULL};
        dds_sample_info_t info;
        while (dds_take(reader, loan, &info, 1, 1) == 1) {
            if (info.valid_data && imu) print_imu(loan[0]);
            else if (info.valid_data) print_diagnostics(loan[0]);
            dds_return_loan(reader, loan, 1);
            loan[0] = NULL;
        }
        fflush(stdout);
    }
    return 0;
}

/* After so many orders. */
static const char* mistake_after(int orders)
{
    static const char* const names[] = {"none", "silent", "none", "late", "none", "ahead", "none", "doubled", "none", "biased"};
    const int last = (int)(sizeof names / sizeof *names) - 1;
    return names[orders < last ? orders : last];
}

/* IMUs 1 and 4 as the body, IMU 2 a third of a turn about (1,1,1) (its x is the body's y, its y the body's z), IMU 3 half a turn about z.
 */
static void measure(int imu, uint64_t count, int biased, geometry_msgs_msg_dds__Vector3_* rate)
{
    static const double body[3] = {0.1, 0.2, -0.3};
    const double sign = imu == 2 ? -1 : 1;
    double own[3] = {sign * body[0], sign * body[1], body[2]};
    for (int i = 0; imu == 1 && i < 3; ++i) own[i] = body[(i + 1) % 3];
    for (int i = 0; i < 3; ++i) own[i] += 1e-4 * sin(1.7 * (double)count + 2.1 * (3 * imu + i)); /* noise of a kind */
    if (biased && imu == 2) own[0] += 0.05;
    *rate = (geometry_msgs_msg_dds__Vector3_){own[0], own[1], own[2]};
}

static void make_writers(dds_entity_t participant, const dds_qos_t* qos, int count, dds_entity_t* topics, dds_entity_t* writers)
{
    for (int i = 0; i < count; ++i) {
        char name[32];
        snprintf(name, sizeof name, "rt/imu_%d/data", i + 1);
        topics[i] = made(dds_create_topic(participant, &sensor_msgs_msg_dds__Imu__desc, name, NULL, NULL), name);
        writers[i] = made(dds_create_writer(participant, topics[i], qos, NULL), name);
    }
}

static sensor_msgs_msg_dds__Imu_ stamped(dds_time_t stamp)
{
    sensor_msgs_msg_dds__Imu_ m;
    memset(&m, 0, sizeof m);
    m.header_.stamp_.sec_ = (int32_t)(stamp / DDS_NSECS_IN_SEC);
    m.header_.stamp_.nanosec_ = (uint32_t)(stamp % DDS_NSECS_IN_SEC);
    m.header_.frame_id_ = "imu";
    m.orientation_covariance_[0] = -1;
    return m;
}

/* Standard normal, the same on every run [Marsaglia's xorshift64, Box & Muller]. */
static double normal(void)
{
    static uint64_t state = 88172645463325252ULL;
    double uniform[2];
    for (int i = 0; i < 2; ++i) {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        uniform[i] = ((double)(state >> 11) + 1) / 9007199254740993.0;
    }
    return sqrt(-2 * log(uniform[0])) * cos(2 * 3.14159265358979323846 * uniform[1]);
}

/* Three IMUs mounted as the body. integration_tests/interop/ros2_test.py knows the biases and the motion. */
static int biased(dds_entity_t participant)
{
    enum { COUNT = 3 };
    static const double degree = 3.14159265358979323846 / 180;
    static const double bias_deg_s[COUNT][3] = {{0.31, -0.22, 0.45}, {-0.6, 0.27, 0.38}, {-0.41, 0.2, 0.55}};
    static const double amplitude[3] = {0.5, 0.4, 0.6}, pace[3] = {1.1, 0.7, 0.9};
    dds_entity_t writers[COUNT], topics[COUNT];
    dds_qos_t* qos = profile("sensor-data");
    make_writers(participant, qos, COUNT, topics, writers);
    dds_delete_qos(qos);
    dds_time_t due = dds_time();
    const dds_time_t turns = due + DDS_SECS(12);
    printf("%lld\n", (long long)turns), fflush(stdout);
    for (; !stop; due += PERIOD_NS) {
        if (due > dds_time()) dds_sleepfor(due - dds_time());
        for (int i = 0; i < COUNT; ++i) {
            const dds_time_t stamp = due - i * DDS_MSECS(1);
            const double since = stamp > turns ? 1e-9 * (double)(stamp - turns) : 0;
            double own[3];
            for (int k = 0; k < 3; ++k) {
                const double gain = orders > 0 && i == 2 && k == 2 ? 0.4 : 1;
                own[k] = gain * amplitude[k] * sin(pace[k] * since) + degree * (bias_deg_s[i][k] + 0.05 * normal());
            }
            sensor_msgs_msg_dds__Imu_ m = stamped(stamp);
            m.angular_velocity_ = (geometry_msgs_msg_dds__Vector3_){own[0], own[1], own[2]};
            dds_write(writers[i], &m);
        }
    }
    return 0;
}

static int robot(dds_entity_t participant)
{
    dds_entity_t writers[IMUS], second = 0, topics[IMUS];
    dds_qos_t* qos = profile("sensor-data");
    make_writers(participant, qos, IMUS, topics, writers);
    const char* last = "";
    dds_time_t due = dds_time();
    for (uint64_t count = 0; !stop; ++count, due += PERIOD_NS) {
        if (due > dds_time()) dds_sleepfor(due - dds_time());
        const char* mistake = mistake_after(orders);
        if (strcmp(mistake, last) != 0) printf("%lld %s\n", (long long)due, mistake), fflush(stdout);
        last = mistake;
        const int doubled = strcmp(mistake, "doubled") == 0;
        if (doubled && !second) second = made(dds_create_writer(participant, topics[1], qos, NULL), "second writer");
        if (!doubled && second) dds_delete(second), second = 0;
        for (int i = 0; i < IMUS; ++i) {
            /* The scheduler may delay this loop; stamps tell when it was meant to measure, and IMUs measure out of step. */
            dds_time_t stamp = due - i * DDS_MSECS(1);
            if (i == 1 && strcmp(mistake, "silent") == 0) continue;
            if (i == 1 && strcmp(mistake, "late") == 0) stamp -= DELAY_NS;
            if (i == 1 && strcmp(mistake, "ahead") == 0) stamp += DDS_SECS(5);
            sensor_msgs_msg_dds__Imu_ m = stamped(stamp);
            measure(i, count, strcmp(mistake, "biased") == 0, &m.angular_velocity_);
            dds_write(writers[i], &m);
            if (i == 1 && second) dds_write(second, &m);
        }
    }
    dds_delete_qos(qos);
    return 0;
}

int main(int argc, char** argv)
{
    const int reads = argc == 5 && (strcmp(argv[2], "imu") == 0 || strcmp(argv[2], "diagnostics") == 0);
    const int moves = argc == 3 && (strcmp(argv[2], "robot") == 0 || strcmp(argv[2], "biased") == 0);
    if (!reads && !moves) return fprintf(stderr, "usage: see the first lines of main.c\n"), 2;
    signal(SIGINT, on_signal);
    signal(SIGTERM, on_signal);
    signal(SIGUSR1, on_order);
    const dds_domainid_t domain = (dds_domainid_t)atoi(argv[1]);
    made(dds_create_domain(domain,
                           "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\" multicast=\"true\"/></Interfaces>"
                           "</General><Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>60"
                           "</MaxAutoParticipantIndex></Discovery><Internal><GenerateKeyhash>true</GenerateKeyhash></Internal>"
                           "</Domain></CycloneDDS>"),
         "domain");
    const dds_entity_t participant = made(dds_create_participant(domain, NULL, NULL), "participant");
    const int result = reads                             ? read_topic(participant, argv[2], argv[3], argv[4])
                       : strcmp(argv[2], "robot") == 0 ? robot(participant)
                                                         : biased(participant);
    dds_delete(DDS_CYCLONEDDS_HANDLE);
    return result;
}
