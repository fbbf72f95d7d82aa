/* Plays a recording as unit 1: usage: publisher_cyclonedds DOMAIN AXES.csv RECORDING.csv [READERS]
 * AXES: per line a unit vector x,y,z and the axis's noise and quantum [rad] in one increment. RECORDING: one frame per line, its time [s],
 * then one increment [rad] per axis; further columns and lines that begin with a letter are passed over; `quorient simulate` writes this.
 * Starts when so many readers of quorient/frame are there (default 1). */
#include <dds/dds.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "quorient_msgs.h"

enum { GYRO = 1, STATED = 1, MAX_AXES = 24 };

static dds_entity_t made(dds_entity_t entity, const char* what)
{
    if (entity >= 0) return entity;
    fprintf(stderr, "%s: %s\n", what, dds_strretcode(-entity));
    exit(1);
}

/* Reads up to `most` numbers of a line. */
static int numbers(char* line, double* values, int most)
{
    int count = 0;
    for (char* word = strtok(line, ", \t\r\n"); word && count < most; word = strtok(NULL, ", \t\r\n")) values[count++] = strtod(word, NULL);
    return count;
}

static dds_entity_t writer_of(dds_entity_t participant, const dds_topic_descriptor_t* type, const char* name, int latched)
{
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
    dds_qset_durability(qos, latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, latched ? 1 : 64);
    const dds_entity_t writer =
        made(dds_create_writer(participant, made(dds_create_topic(participant, type, name, NULL, NULL), name), qos, NULL), name);
    dds_delete_qos(qos);
    return writer;
}

static void wait_for_matches(dds_entity_t writer, uint32_t readers)
{
    dds_publication_matched_status_t matched = {0};
    while (dds_get_publication_matched_status(writer, &matched) == 0 && matched.current_count < readers) dds_sleepfor(DDS_MSECS(5));
}

/* A match here says that we know the reader, not that the reader knows us: frames that go out at once would miss it. Whoever has acknowledged
   a description written after the match knows both writers, since the one of frames was announced before. */
static void describe_to_readers(dds_entity_t descriptions, const quorient_msgs_ClusterDescription* description, dds_entity_t frames, uint32_t readers)
{
    wait_for_matches(frames, readers);
    wait_for_matches(descriptions, readers);
    made(dds_write(descriptions, description), "description");
    made(dds_wait_for_acks(descriptions, DDS_SECS(10)), "acknowledgement of the description within 10 s");
}

int main(int argc, char** argv)
{
    FILE* axes = argc > 3 ? fopen(argv[2], "r") : NULL;
    FILE* recording = axes ? fopen(argv[3], "r") : NULL;
    if (!recording) return fprintf(stderr, "usage: publisher_cyclonedds DOMAIN AXES.csv RECORDING.csv [READERS]\n"), 2;

    static quorient_msgs_ClusterDescription description; /* all that is not set stays 0 */
    static quorient_msgs_SensorFrame frame;
    char line[4096];
    double row[1 + MAX_AXES], before_s = 0;
    while (description.axis_count < MAX_AXES && fgets(line, sizeof line, axes)) {
        const int axis = description.axis_count;
        if (numbers(line, row, 5) != 5) continue;
        memcpy(description.axis[axis], row, sizeof description.axis[axis]);
        description.sigma[axis] = row[3];
        description.quantum[axis] = row[4];
        description.instrument[axis] = description.axis_count++; /* each axis an instrument of its own */
    }
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    description.epoch = frame.epoch = (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec; /* larger than any before */
    description.revision = frame.description_revision = 1;
    description.unit = frame.unit = 1;
    description.kind = frame.kind = GYRO;
    description.instrument_count = frame.axis_count = description.axis_count;
    description.initial_attitude[0] = 1;
    description.initial_attitude_known = STATED;
    frame.valid_mask = (1u << description.axis_count) - 1;

    const dds_domainid_t domain = (dds_domainid_t)atoi(argv[1]);
    made(dds_create_domain(domain,
                           "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\" multicast=\"true\"/></Interfaces>"
                           "</General><Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>60"
                           "</MaxAutoParticipantIndex></Discovery><Internal><GenerateKeyhash>true</GenerateKeyhash></Internal>"
                           "</Domain></CycloneDDS>"),
         "domain");
    const dds_entity_t participant = made(dds_create_participant(domain, NULL, NULL), "participant");
    const dds_entity_t frames = writer_of(participant, &quorient_msgs_SensorFrame_desc, "quorient/frame", 0);
    const dds_entity_t descriptions = writer_of(participant, &quorient_msgs_ClusterDescription_desc, "quorient/cluster", 1);

    dds_time_t due = 0;
    while (fgets(line, sizeof line, recording)) {
        if (numbers(line, row, 1 + description.axis_count) != 1 + description.axis_count || row[0] <= before_s) continue;
        frame.interval_s = row[0] - before_s;
        frame.sample_time_ns = llround(row[0] * 1e9);
        for (int axis = 0; axis < description.axis_count; ++axis) frame.accumulated[axis] += frame.increment[axis] = row[1 + axis];
        if (frame.sequence_number == 0) {
            description.interval_s = frame.interval_s;
            describe_to_readers(descriptions, &description, frames, argc > 4 ? (uint32_t)atoi(argv[4]) : 1);
            due = dds_time();
        }
        due += llround(frame.interval_s * 1e9);
        if (due > dds_time()) dds_sleepfor(due - dds_time());
        made(dds_write(frames, &frame), "frame");
        ++frame.sequence_number;
        before_s = row[0];
    }
    printf("%llu frames of %u axes, epoch %llu\n", (unsigned long long)frame.sequence_number, description.axis_count,
           (unsigned long long)description.epoch);
    dds_sleepfor(DDS_MSECS(500)); /* for the slowest reader */
    dds_delete(DDS_CYCLONEDDS_HANDLE);
    return 0;
}
