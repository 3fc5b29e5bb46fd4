"""Driver and server for LoLA, NAO V6's protocol of joint frames at 12 ms."""
