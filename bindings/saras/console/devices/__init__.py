"""The devices that come with the console. Each module has ``make(side, options) -> HandleDevice``."""
