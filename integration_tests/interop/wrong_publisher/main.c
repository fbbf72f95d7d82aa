/* A foreign publisher of four gyros at rest that makes one mistake: usage: wrong_publisher DOMAIN MISTAKE. Publishes a good frame every
 * 5 ms; from frame 60 on, or from the start where it is about the description, it does what MISTAKE says. Ends on SIGTERM. */
#include <dds/dds.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "quorient_msgs.h"

enum { GYRO = 1, STATED = 1, AXES = 4, GOOD_FRAMES = 60, FOREIGN_UNITS = 10000, UNITS_PER_FRAME = 20 };
#define INTERVAL_NS 5000000

static volatile sig_atomic_t stop = 0;
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

static dds_entity_t writer_of(dds_entity_t participant, const dds_topic_descriptor_t* type, const char* name, int latched, int reliable)
{
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, DDS_MSECS(100));
    dds_qset_durability(qos, latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, latched ? 1 : 64);
    const dds_entity_t writer =
        made(dds_create_writer(participant, made(dds_create_topic(participant, type, name, NULL, NULL), name), qos, NULL), name);
    dds_delete_qos(qos);
    return writer;
}

static quorient_msgs_ClusterDescription describe(uint64_t epoch)
{
    quorient_msgs_ClusterDescription d;
    memset(&d, 0, sizeof d);
    d.epoch = epoch;
    d.interval_s = INTERVAL_NS * 1e-9;
    for (int axis = 0; axis < AXES; ++axis) { /* a cone about z */
        const double azimuth = axis * acos(-1.0) / 2;
        d.axis[axis][0] = sqrt(2.0 / 3) * cos(azimuth);
        d.axis[axis][1] = sqrt(2.0 / 3) * sin(azimuth);
        d.axis[axis][2] = sqrt(1.0 / 3);
        d.instrument[axis] = (uint8_t)axis;
        d.quantum[axis] = 1e-6;
    }
    d.initial_attitude[0] = 1;
    d.initial_attitude_known = STATED;
    d.unit = d.revision = 1;
    d.kind = GYRO;
    d.axis_count = d.instrument_count = AXES;
    return d;
}

/* Descriptions and frames of the next of FOREIGN_UNITS other units, each an instance of its own. */
static void publish_foreign_units(dds_entity_t descriptions, dds_entity_t frames, quorient_msgs_ClusterDescription description,
                                  quorient_msgs_SensorFrame frame)
{
    static uint32_t published = 0;
    for (int i = 0; i < UNITS_PER_FRAME && published < FOREIGN_UNITS; ++i) {
        description.unit = frame.unit = 2 + published++;
        made(dds_write(descriptions, &description), "description");
        made(dds_write(frames, &frame), "frame");
    }
}

int main(int argc, char** argv)
{
    if (argc != 3) return fprintf(stderr, "usage: wrong_publisher DOMAIN MISTAKE\n"), 2;
    const char* mistake = argv[2];
#define MISTAKE(name) (strcmp(mistake, name) == 0)
    signal(SIGTERM, on_signal);
    const dds_domainid_t domain = (dds_domainid_t)atoi(argv[1]);
    made(dds_create_domain(domain,
                           "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\" multicast=\"true\"/></Interfaces>"
                           "</General><Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>60"
                           "</MaxAutoParticipantIndex></Discovery><Internal><GenerateKeyhash>true</GenerateKeyhash></Internal>"
                           "</Domain></CycloneDDS>"),
         "domain");
    const dds_entity_t participant = made(dds_create_participant(domain, NULL, NULL), "participant");
    if (MISTAKE("type") || MISTAKE("qos")) {
        const int other_type = MISTAKE("type");
        writer_of(participant, other_type ? &quorient_msgs_ServiceStatus_desc : &quorient_msgs_SensorFrame_desc, "quorient/frame", 0, other_type);
        while (!stop) dds_sleepfor(DDS_MSECS(5));
        return 0;
    }
    const dds_entity_t frames = writer_of(participant, &quorient_msgs_SensorFrame_desc, "quorient/frame", 0, 1);
    const dds_entity_t descriptions = writer_of(participant, &quorient_msgs_ClusterDescription_desc, "quorient/cluster", 1, 1);

    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    const uint64_t epoch = (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
    quorient_msgs_ClusterDescription description = describe(epoch);
    if (MISTAKE("axis-nan")) description.axis[2][0] = nan("");
    if (MISTAKE("axis-norm")) description.axis[2][0] = 0;
    if (MISTAKE("no-axes")) description.axis_count = 0;
    if (MISTAKE("axes-255")) description.axis_count = 255;
    if (MISTAKE("instrument-255")) description.instrument[3] = 255;
    if (MISTAKE("interval-nan")) description.interval_s = nan("");
    if (MISTAKE("sigma-negative")) description.sigma[1] = -1;
    quorient_msgs_SensorFrame frame;
    memset(&frame, 0, sizeof frame);
    frame.epoch = epoch;
    frame.unit = frame.description_revision = 1;
    frame.kind = GYRO;
    frame.axis_count = AXES;
    frame.valid_mask = (1u << AXES) - 1;
    dds_publication_matched_status_t matched = {0};
    while (!stop && dds_get_publication_matched_status(frames, &matched) == 0 && matched.current_count < 6) dds_sleepfor(DDS_MSECS(5));
    while (!stop && dds_get_publication_matched_status(descriptions, &matched) == 0 && matched.current_count < 6) dds_sleepfor(DDS_MSECS(5));
    /* Whoever has acknowledged a description written after the match knows the writer of frames too, which was announced before. */
    if (!MISTAKE("no-description")) made(dds_write(descriptions, &description), "description");
    if (!stop) made(dds_wait_for_acks(descriptions, DDS_SECS(10)), "acknowledgement of the description within 10 s");
    dds_time_t due = dds_time();
    for (uint64_t count = 0; !stop; ++count, due += INTERVAL_NS) {
        frame.interval_s = INTERVAL_NS * 1e-9;
        frame.sequence_number = count;
        frame.sample_time_ns = (int64_t)(count + 1) * INTERVAL_NS;
        if (count >= GOOD_FRAMES) {
            if (MISTAKE("revision")) frame.description_revision = 9;
            if (MISTAKE("restart")) frame.sequence_number = count - GOOD_FRAMES;
            if (MISTAKE("axis-count")) frame.axis_count = AXES + 1;
            if (MISTAKE("interval")) frame.interval_s = 0;
            if (MISTAKE("time")) frame.sample_time_ns = GOOD_FRAMES * (int64_t)INTERVAL_NS;
            if (MISTAKE("value")) frame.increment[2] = nan("");
            if (MISTAKE("sequence-edge")) frame.sequence_number = UINT64_MAX - (count == GOOD_FRAMES);
            if (MISTAKE("units")) publish_foreign_units(descriptions, frames, description, frame);
            if (MISTAKE("other-axes") && count == GOOD_FRAMES) {
                description.epoch = frame.epoch = epoch + 1;
                description.axis_count = frame.axis_count = 3;
                description.instrument_count = 3;
                made(dds_write(descriptions, &description), "description");
                dds_sleepfor(DDS_MSECS(300)); /* the old epoch must have been silent */
                due = dds_time();
            }
        }
        if (due > dds_time()) dds_sleepfor(due - dds_time());
        made(dds_write(frames, &frame), "frame");
    }
    dds_delete(DDS_CYCLONEDDS_HANDLE);
    return 0;
}
