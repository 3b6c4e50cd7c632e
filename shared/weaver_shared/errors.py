"""The few exceptions of the project; each message is one sentence a person can act on."""


class WeaverError(Exception):
    """Anything the command line answers with one sentence and an exit code above 0."""


class ConfigurationError(WeaverError):
    """A setting, name or file is not valid; the message says what was found and what is valid."""


class MessageError(WeaverError):
    """Bytes from the bus that are not a message we know."""


class InputError(WeaverError):
    """A recording, picture, cloud or map that can not be used; the message says why."""


class ResourceError(WeaverError):
    """A port, device, display or library that is needed and not there."""
