// Prints the voted attitude: usage: consumer_fastdds [DOMAIN [KEYS NAME]]. One line per sample until SIGINT or SIGTERM.
// In a secured system: KEYS is the directory of `quorient keys`, NAME the consumer's identity in it.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fastdds/dds/core/condition/WaitSet.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <memory>
#include <string>

#include "fastdds_version.hpp"
#include "quorient_msgsPubSubTypes.hpp"

using namespace eprosima::fastdds::dds;

static volatile std::sig_atomic_t stop = 0;
static void on_signal(int)
{
    stop = 1;
}

/// Loopback, as the demo. Fast DDS 2.9.1 must know every address from the start; 30 participants of a host are enough here.
static DomainParticipantQos on_loopback(unsigned domain)
{
    DomainParticipantQos qos;
    auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList = {"127.0.0.1"};
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(udp);
    auto& builtin = qos.wire_protocol().builtin;
    builtin.discovery_config.initial_announcements.count = 50;
    builtin.discovery_config.initial_announcements.period = {0, 100'000'000};
    for (unsigned port = 9; port < 70; ++port) {
        fastdds_version::rtps::Locator_t locator;
        fastdds_version::rtps::IPLocator::setIPv4(locator, port == 9 ? "239.255.0.1" : "127.0.0.1");
        locator.port = 7400 + 250 * domain + (port == 9 ? 0 : port);
        builtin.initialPeersList.push_back(locator);
    }
    return qos;
}

/// DDS Security: the plug-ins, and the files of an identity.
static void secure(DomainParticipantQos& qos, const std::string& keys, const std::string& name)
{
    const auto set = [&](const std::string& property, const std::string& value) { qos.properties().properties().emplace_back(property, value); };
    const std::string shared = "file://" + keys + "/shared/", own = "file://" + keys + "/" + name + "/";
    set("dds.sec.auth.plugin", "builtin.PKI-DH");
    set("dds.sec.auth.builtin.PKI-DH.identity_ca", shared + "identity_ca.pem");
    set("dds.sec.auth.builtin.PKI-DH.identity_certificate", own + "fastdds.pem");
    set("dds.sec.auth.builtin.PKI-DH.private_key", own + "key.pem");
    set("dds.sec.auth.builtin.PKI-DH.identity_crl", shared + "revoked.pem");
    set("dds.sec.access.plugin", "builtin.Access-Permissions");
    set("dds.sec.access.builtin.Access-Permissions.permissions_ca", shared + "permissions_ca.pem");
    set("dds.sec.access.builtin.Access-Permissions.governance", shared + "governance.p7s");
    set("dds.sec.access.builtin.Access-Permissions.permissions", own + "permissions.p7s");
    set("dds.sec.crypto.plugin", "builtin.AES-GCM-GMAC");
}

int main(int argc, char** argv)
{
    const unsigned domain = argc > 1 ? static_cast<unsigned>(std::atoi(argv[1])) : 42;
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    auto* factory = DomainParticipantFactory::get_instance();
    auto joining = on_loopback(domain);
    if (argc > 3) secure(joining, argv[2], argv[3]);
    auto* participant = factory->create_participant(domain, joining);
    if (!participant) return std::fprintf(stderr, "cannot join domain %u\n", domain), 1;
    TypeSupport type{new quorient_msgs::VotedAttitudePubSubType};
    type.register_type(participant);
    auto* topic = participant->create_topic("quorient/voted", type.get_type_name(), TOPIC_QOS_DEFAULT);

    DataReaderQos qos;
    qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
    qos.history().depth = 64;
    qos.ownership().kind = EXCLUSIVE_OWNERSHIP_QOS;  // the one line: of several voters, DDS shows the owner's samples
    // Fast DDS notices that an owner has died only by the reader's own lease; Cyclone DDS by the writer's.
    qos.liveliness().kind = MANUAL_BY_TOPIC_LIVELINESS_QOS;
    qos.liveliness().lease_duration = {0, 50'000'000};
    auto* reader = participant->create_subscriber(SUBSCRIBER_QOS_DEFAULT)->create_datareader(topic, qos);
    if (!reader) return std::fprintf(stderr, "cannot read quorient/voted\n"), 1;

    WaitSet waitset;
    reader->get_statuscondition().set_enabled_statuses(StatusMask::data_available());
    waitset.attach_condition(reader->get_statuscondition());
    while (!stop) {
        ConditionSeq triggered;
        waitset.wait(triggered, fastdds_version::Duration{0, 100'000'000});
        quorient_msgs::VotedAttitude voted;
        SampleInfo info;
        while (fastdds_version::is_ok(reader->take_next_sample(&voted, &info))) {
            if (!info.valid_data) continue;  // the owner left; the next sample comes from another voter
            const auto& q = voted.attitude();
            std::printf("%llu %llu %llu voter %u level %u mode %u q %.17g %.17g %.17g %.17g sigma %.3g rad\n",
                        static_cast<unsigned long long>(voted.epoch()), static_cast<unsigned long long>(voted.sequence_number()),
                        static_cast<unsigned long long>(voted.output_sequence()), voted.voter(), voted.level(), voted.mode(), q[0], q[1],
                        q[2], q[3], voted.angle_sigma_rad());
        }
        std::fflush(stdout);
    }
    participant->delete_contained_entities();
    factory->delete_participant(participant);
}
