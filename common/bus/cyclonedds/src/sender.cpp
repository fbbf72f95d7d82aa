#include "sender.hpp"

#include <algorithm>
#include <memory>

namespace quorient::bus::cyclonedds {

namespace {

struct Free {
    void operator()(dds_builtintopic_endpoint_t* endpoint) const { dds_builtintopic_free_endpoint(endpoint); }
};
using Endpoint = std::unique_ptr<dds_builtintopic_endpoint_t, Free>;

Announcement read(const dds_qos_t* qos)
{
    Announcement result;
    char* name = nullptr;
    if (dds_qget_entity_name(qos, &name) && name) result.name = name;
    dds_free(name);
    void* data = nullptr;
    std::size_t size = 0;
    if (dds_qget_userdata(qos, &data, &size) && data) {
        const auto* octets = static_cast<const std::uint8_t*>(data);
        result.user_data.assign(octets, octets + size);
    }
    dds_free(data);
    return result;
}

Announcement announcement_of(dds_entity_t reader, dds_instance_handle_t participant)
{
    const auto announcements = dds_create_reader(dds_get_participant(reader), DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr);
    if (announcements < 0) return {};
    Announcement result;
    void* samples[1] = {nullptr};
    dds_sample_info_t info{};
    if (dds_read_instance(announcements, samples, &info, 1, 1, participant) == 1) {
        if (info.valid_data) result = read(static_cast<const dds_builtintopic_participant_t*>(samples[0])->qos);
        dds_return_loan(announcements, samples, 1);
    }
    dds_delete(announcements);
    return result;
}

}  // namespace

Announcement announcement_of_writer(dds_entity_t reader, dds_instance_handle_t writer)
{
    const Endpoint endpoint{dds_get_matched_publication_data(reader, writer)};
    return endpoint ? announcement_of(reader, endpoint->participant_instance_handle) : Announcement{};
}

Sender sender_of(dds_entity_t reader, dds_instance_handle_t writer, bool secured)
{
    const Endpoint endpoint{dds_get_matched_publication_data(reader, writer)};
    if (!endpoint) return {};
    GuidPrefix guid{};
    std::copy_n(endpoint->participant_key.v, guid.size(), guid.begin());
    return make_sender(announcement_of(reader, endpoint->participant_instance_handle).name, guid, secured);
}

}  // namespace quorient::bus::cyclonedds
