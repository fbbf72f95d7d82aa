/* Prints the voted attitude: usage: consumer_cyclonedds [DOMAIN [KEYS NAME]]. One line per sample until SIGINT or SIGTERM.
   In a secured system: KEYS is the directory of `quorient keys`, NAME the consumer's identity in it. */
#include <dds/dds.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

#include "quorient_msgs.h"

static volatile sig_atomic_t stop = 0;
static void on_signal(int number)
{
    (void)number, stop = 1;
}

static dds_entity_t made(dds_entity_t entity, const char* what)
{
    if (entity >= 0) return entity;
    fprintf(stderr, "%s: %s\n", what, dds_strretcode(-entity));
    exit(1);
}

static void set(dds_qos_t* qos, const char* property, const char* scheme, const char* folder, const char* file)
{
    char value[1024];
    snprintf(value, sizeof value, "%s%s%s%s", scheme, folder, *folder ? "/" : "", file);
    dds_qset_prop(qos, property, value);
}

/* DDS Security: the plug-ins, as Debian keeps them, and the files of an identity. */
static dds_qos_t* secured(const char* keys, const char* name)
{
    static const char* const plugins[3][3] = {{"auth", "authentication", "libdds_security_auth.so"},
                                              {"crypto", "crypto", "libdds_security_crypto.so"},
                                              {"access", "access_control", "libdds_security_ac.so"}};
    char property[128], shared[512], own[512];
    dds_qos_t* qos = dds_create_qos();
    for (int i = 0; i < 3; ++i) {
        snprintf(property, sizeof property, "dds.sec.%s.library.path", plugins[i][0]);
        set(qos, property, "", PLUGINS, plugins[i][2]);
        snprintf(property, sizeof property, "dds.sec.%s.library.init", plugins[i][0]);
        set(qos, property, "init_", "", plugins[i][1]);
        snprintf(property, sizeof property, "dds.sec.%s.library.finalize", plugins[i][0]);
        set(qos, property, "finalize_", "", plugins[i][1]);
    }
    snprintf(shared, sizeof shared, "%s/shared", keys);
    snprintf(own, sizeof own, "%s/%s", keys, name);
    set(qos, "dds.sec.auth.identity_ca", "file:", shared, "identity_ca.pem");
    set(qos, "dds.sec.auth.identity_certificate", "file:", own, "cyclonedds.pem");
    set(qos, "dds.sec.auth.private_key", "file:", own, "key.pem");
    set(qos, "org.eclipse.cyclonedds.sec.auth.crl", "file:", shared, "revoked.pem");
    set(qos, "dds.sec.access.permissions_ca", "file:", shared, "permissions_ca.pem");
    set(qos, "dds.sec.access.governance", "file:", shared, "governance.p7s");
    set(qos, "dds.sec.access.permissions", "file:", own, "permissions.p7s");
    return qos;
}

int main(int argc, char** argv)
{
    const dds_domainid_t domain = argc > 1 ? (dds_domainid_t)atoi(argv[1]) : 42;
    signal(SIGINT, on_signal);
    signal(SIGTERM, on_signal);
    /* Loopback, as the demo; GenerateKeyhash so that Fast DDS peers see us leave. */
    made(dds_create_domain(domain,
                           "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\" multicast=\"true\"/></Interfaces>"
                           "</General><Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>60"
                           "</MaxAutoParticipantIndex></Discovery><Internal><GenerateKeyhash>true</GenerateKeyhash></Internal>"
                           "</Domain></CycloneDDS>"),
         "domain");
    dds_qos_t* security = argc > 3 ? secured(argv[2], argv[3]) : NULL;
    const dds_entity_t participant = made(dds_create_participant(domain, security, NULL), "participant");
    dds_delete_qos(security);
    const dds_entity_t topic =
        made(dds_create_topic(participant, &quorient_msgs_VotedAttitude_desc, "quorient/voted", NULL, NULL), "topic");

    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 64);
    dds_qset_ownership(qos, DDS_OWNERSHIP_EXCLUSIVE); /* the one line: of several voters, DDS shows the owner's samples */
    const dds_entity_t reader = made(dds_create_reader(participant, topic, qos, NULL), "reader");
    dds_delete_qos(qos);

    const dds_entity_t waitset = made(dds_create_waitset(participant), "wait set");
    dds_waitset_attach(waitset, made(dds_create_readcondition(reader, DDS_ANY_STATE), "condition"), 0);
    while (!stop) {
        dds_attach_t triggered;
        dds_waitset_wait(waitset, &triggered, 1, DDS_MSECS(100));
        quorient_msgs_VotedAttitude voted;
        void* samples[1] = {&voted};
        dds_sample_info_t info;
        while (dds_take(reader, samples, &info, 1, 1) == 1) {
            if (!info.valid_data) continue; /* the owner left; the next sample comes from another voter */
            printf("%llu %llu %llu voter %u level %u mode %u q %.17g %.17g %.17g %.17g sigma %.3g rad\n", (unsigned long long)voted.epoch,
                   (unsigned long long)voted.sequence_number, (unsigned long long)voted.output_sequence, voted.voter, voted.level,
                   voted.mode, voted.attitude[0], voted.attitude[1], voted.attitude[2], voted.attitude[3], voted.angle_sigma_rad);
        }
        fflush(stdout);
    }
    dds_delete(DDS_CYCLONEDDS_HANDLE);
    return 0;
}
