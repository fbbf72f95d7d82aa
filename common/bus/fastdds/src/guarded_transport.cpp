#include "guarded_transport.hpp"

#include "rtps_guard.hpp"

#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/TransportReceiverInterface.h>

namespace quorient::bus::fastdds {

namespace rtps = eprosima::fastdds::rtps;
using eprosima::fastrtps::rtps::Locator_t;
using eprosima::fastrtps::rtps::LocatorsIterator;
using eprosima::fastrtps::rtps::octet;

namespace {

struct GuardedDescriptor final : rtps::ChainingTransportDescriptor {
    using rtps::ChainingTransportDescriptor::ChainingTransportDescriptor;
    rtps::TransportInterface* create_transport() const override;
};

class GuardedTransport final : public rtps::ChainingTransport {
public:
    explicit GuardedTransport(const GuardedDescriptor& descriptor) : rtps::ChainingTransport(descriptor), descriptor_(descriptor) {}

    rtps::TransportDescriptorInterface* get_configuration() override { return &descriptor_; }

    bool send(eprosima::fastrtps::rtps::SenderResource* below, const octet* buffer, std::uint32_t size, LocatorsIterator* begin,
              LocatorsIterator* end, const std::chrono::steady_clock::time_point& timeout) override
    {
        return below->send(buffer, size, begin, end, timeout);
    }

    void receive(rtps::TransportReceiverInterface* above, const octet* buffer, std::uint32_t size, const Locator_t& local,
                 const Locator_t& remote) override
    {
        if (is_sound_rtps(buffer, size)) above->OnDataReceived(buffer, size, local, remote);
    }

private:
    GuardedDescriptor descriptor_;
};

rtps::TransportInterface* GuardedDescriptor::create_transport() const
{
    return new GuardedTransport(*this);  // Fast DDS takes it over
}

}  // namespace

std::shared_ptr<rtps::TransportDescriptorInterface> guarded(std::shared_ptr<rtps::TransportDescriptorInterface> transport)
{
    return std::make_shared<GuardedDescriptor>(std::move(transport));
}

}  // namespace quorient::bus::fastdds
