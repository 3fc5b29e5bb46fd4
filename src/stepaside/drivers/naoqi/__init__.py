"""NAOqi: the services of NAO and Pepper, called over the network."""
