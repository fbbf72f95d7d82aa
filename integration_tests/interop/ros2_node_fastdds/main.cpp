// A plain DDS reader of ROS 2's types: usage: ros2_node_fastdds DOMAIN imu|diagnostics TOPIC sensor-data|default. Prints as
// ros2_node_cyclonedds does; ends on SIGTERM.
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
#include "ros2_msgsPubSubTypes.hpp"

using namespace eprosima::fastdds::dds;

static volatile std::sig_atomic_t stop = 0;
static void on_signal(int)
{
    stop = 1;
}

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

static void print(const sensor_msgs::msg::dds_::Imu_& m)
{
    const auto& q = m.orientation_();
    const auto& w = m.angular_velocity_();
    std::printf("%d.%09u %s q %.17g %.17g %.17g %.17g covariance %.9g rate %.9g %.9g %.9g covariance %.9g acceleration covariance %.9g\n",
                m.header_().stamp_().sec_(), m.header_().stamp_().nanosec_(), m.header_().frame_id_().c_str(), q.w_(), q.x_(), q.y_(),
                q.z_(), m.orientation_covariance_()[0], w.x_(), w.y_(), w.z_(), m.angular_velocity_covariance_()[0],
                m.linear_acceleration_covariance_()[0]);
}

static void print(const diagnostic_msgs::msg::dds_::DiagnosticArray_& m)
{
    for (const auto& s : m.status_())
        std::printf("%u|%s|%s|%s\n", s.level_(), s.name_().c_str(), s.message_().c_str(), s.hardware_id_().c_str());
}

template <class Message, class Support>
static int read(DomainParticipant* participant, const char* topic_name, bool sensor_data)
{
    TypeSupport type{new Support};
    type.register_type(participant);
    auto* topic = participant->create_topic(topic_name, type.get_type_name(), TOPIC_QOS_DEFAULT);
    DataReaderQos qos;
    qos.reliability().kind = sensor_data ? BEST_EFFORT_RELIABILITY_QOS : RELIABLE_RELIABILITY_QOS;
    qos.history().depth = sensor_data ? 5 : 10;
    auto* reader = participant->create_subscriber(SUBSCRIBER_QOS_DEFAULT)->create_datareader(topic, qos);
    if (!reader) return std::fprintf(stderr, "cannot read %s\n", topic_name), 1;
    WaitSet waitset;
    reader->get_statuscondition().set_enabled_statuses(StatusMask::data_available());
    waitset.attach_condition(reader->get_statuscondition());
    while (!stop) {
        ConditionSeq triggered;
        waitset.wait(triggered, fastdds_version::Duration{0, 100'000'000});
        Message message;
        SampleInfo info;
        while (fastdds_version::is_ok(reader->take_next_sample(&message, &info))) {
            if (info.valid_data) print(message);
        }
        std::fflush(stdout);
    }
    return 0;
}

int main(int argc, char** argv)
{
    if (argc != 5) return std::fprintf(stderr, "usage: ros2_node_fastdds DOMAIN imu|diagnostics TOPIC sensor-data|default\n"), 2;
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    const auto domain = static_cast<unsigned>(std::atoi(argv[1]));
    auto* factory = DomainParticipantFactory::get_instance();
    auto* participant = factory->create_participant(domain, on_loopback(domain));
    if (!participant) return std::fprintf(stderr, "cannot join domain %u\n", domain), 1;
    const bool sensor_data = std::string{argv[4]} == "sensor-data";
    using namespace sensor_msgs::msg::dds_;
    using namespace diagnostic_msgs::msg::dds_;
    const int result = std::string{argv[2]} == "imu"
                           ? read<Imu_, Imu_PubSubType>(participant, argv[3], sensor_data)
                           : read<DiagnosticArray_, DiagnosticArray_PubSubType>(participant, argv[3], sensor_data);
    participant->delete_contained_entities();
    factory->delete_participant(participant);
    return result;
}
