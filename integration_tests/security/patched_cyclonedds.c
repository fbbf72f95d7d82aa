/* A member that has patched its Cyclone DDS: the vendor's access control, except that every check of the member's own endpoints passes.
   Cyclone DDS loads it in place of libdds_security_ac.so, whose path is in ROGUE_ACCESS_CONTROL. */

#include <dds/security/dds_security_api.h>
#include <dlfcn.h>
#include <stdlib.h>

static void *library;

static DDS_Security_boolean may_write(dds_security_access_control *instance, const DDS_Security_PermissionsHandle permissions,
                                      const DDS_Security_DomainId domain, const char *topic, const DDS_Security_Qos *qos,
                                      const DDS_Security_PartitionQosPolicy *partition, const DDS_Security_DataTags *tag,
                                      DDS_Security_SecurityException *exception)
{
    (void)instance, (void)permissions, (void)domain, (void)topic, (void)qos, (void)partition, (void)tag, (void)exception;
    return true;
}

static DDS_Security_boolean may_have_topic(dds_security_access_control *instance, const DDS_Security_PermissionsHandle permissions,
                                           const DDS_Security_DomainId domain, const char *topic, const DDS_Security_Qos *qos,
                                           DDS_Security_SecurityException *exception)
{
    (void)instance, (void)permissions, (void)domain, (void)topic, (void)qos, (void)exception;
    return true;
}

int init_access_control(const char *argument, void **context, struct ddsi_domaingv *gv)
{
    library = dlopen(getenv("ROGUE_ACCESS_CONTROL"), RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) return 1;
    const plugin_init init = (plugin_init)dlsym(library, "init_access_control");
    if (init == NULL || init(argument, context, gv) != 0) return 1;
    dds_security_access_control *access = *context;
    access->check_create_datawriter = may_write;
    access->check_create_datareader = may_write;
    access->check_create_topic = may_have_topic;
    return 0;
}

int finalize_access_control(void *context)
{
    const plugin_finalize finalize = (plugin_finalize)dlsym(library, "finalize_access_control");
    return finalize(context);
}
